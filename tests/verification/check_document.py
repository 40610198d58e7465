#!/usr/bin/env python3
"""Runs the verification program and holds the table in docs/verification.md against the one it prints.

check_document.py PROGRAM DOCUMENT [--write]: with --write the document's table is brought up to date.
"""
import pathlib
import subprocess
import sys

program, document = sys.argv[1], pathlib.Path(sys.argv[2])
run = subprocess.run([program], capture_output=True, text=True)
if run.returncode:
    sys.exit(f"{program} fails:\n{run.stdout}{run.stderr}")
printed = [line for line in run.stdout.splitlines() if line.startswith("|")]
begin, end = "<!-- table -->\n", "<!-- end of table -->"
before, rest = document.read_text().split(begin)
table, after = rest.split(end)
if "--write" in sys.argv:
    document.write_text(before + begin + "\n".join(printed) + "\n" + end + after)
    sys.exit(0)


def rows(lines):
    """Rows by case, source, published and asked: what they are off by."""
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("| ")]
    return {tuple(row[:4]): row[4] for row in cells}


ours, known = rows(printed), rows(table.splitlines())
wrong = [f"not in the document: {case}" for case in ours if case not in known]
wrong += [f"not printed by the program: {case}" for case in known if case not in ours]
wrong += [
    f"{case}: the document says {known[case]}, the program {off}"
    for case, off in ours.items()
    if case in known and known[case] != off and "e-" not in off  # rounding moves from one machine to another
]
print("\n".join(wrong) or f"{len(ours)} rows agree")
sys.exit(1 if wrong else 0)
