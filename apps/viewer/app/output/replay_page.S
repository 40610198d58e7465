# The bundled replay page as bytes of the program.
        .section .rodata
        .global topple_replay_page_begin
        .global topple_replay_page_end
topple_replay_page_begin:
        .incbin REPLAY_PAGE
topple_replay_page_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
