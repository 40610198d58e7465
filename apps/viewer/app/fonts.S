# DejaVu Sans and DejaVu Sans Mono as bytes of the program, so that a copied program still writes readable text.
        .section .rodata
        .global topple_font_begin
        .global topple_font_end
        .global topple_table_font_begin
        .global topple_table_font_end
topple_font_begin:
        .incbin TEXT_FONT
topple_font_end:
topple_table_font_begin:
        .incbin TABLE_FONT
topple_table_font_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
