#!/usr/bin/env python3
"""Lines that were run, of each file that GCC counted: table.py BUILD [--least PERCENT] [--lines]."""
import argparse, gzip, json, pathlib, subprocess, sys, tempfile


def counted(build):
    """File -> line -> how often, of every .gcda below a folder; headers are left out."""
    files = {}
    root = pathlib.Path(__file__).resolve().parents[2]
    for notes in sorted(build.rglob("*.gcno")):
        data = notes.with_suffix(".gcda")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["gcov", "--json-format", str(data if data.exists() else notes)], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            for made in pathlib.Path(folder).glob("*.gz"):
                report = json.loads(gzip.open(made).read())
                for file in report["files"]:
                    path = pathlib.Path(report["current_working_directory"], file["file"]).resolve()
                    if path.suffix != ".cpp" or root not in path.parents:
                        continue
                    lines = files.setdefault(str(path.relative_to(root)), {})
                    for line in file["lines"]:
                        number = line["line_number"]
                        lines[number] = max(lines.get(number, 0), line["count"])
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--least", type=float, default=0)
    parser.add_argument("--lines", action="store_true", help="name those that nothing runs")
    options = parser.parse_args()
    files = counted(options.build.resolve())
    all_run = all_lines = 0
    print("| file | lines | run, % |\n| --- | --- | --- |")
    for name, lines in sorted(files.items()):
        run = sum(count > 0 for count in lines.values())
        all_run, all_lines = all_run + run, all_lines + len(lines)
        print(f"| {name} | {len(lines)} | {100 * run / len(lines):.1f} |")
        if options.lines and run < len(lines):
            print("  not run: " + " ".join(str(line) for line, count in sorted(lines.items()) if count == 0))
    share = 100 * all_run / max(all_lines, 1)
    print(f"| all {len(files)} | {all_lines} | {share:.1f} |")
    return 0 if files and share >= options.least else 1


if __name__ == "__main__":
    sys.exit(main())
