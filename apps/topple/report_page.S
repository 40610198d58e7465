# The bundled report page as bytes of the program.
        .section .rodata
        .global topple_report_page_begin
        .global topple_report_page_end
topple_report_page_begin:
        .incbin REPORT_PAGE
topple_report_page_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
