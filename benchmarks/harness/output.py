"""Tables on the terminal, CSV, gnuplot figures and the one page that holds them all."""

import csv
import html
import os
import shutil
import subprocess


def cell(value):
    if value is None:
        return "-"
    if isinstance(value, float):
        return "%.3g" % value
    return str(value)


def print_table(rows, columns):
    texts = [[title for _, title in columns]] + [[cell(row.get(key)) for key, _ in columns] for row in rows]
    widths = [max(len(line[i]) for line in texts) for i in range(len(columns))]
    for line in texts:
        print("  ".join(text.rjust(width) if i else text.ljust(width) for i, (text, width) in enumerate(zip(line, widths))))


def write_csv(path, rows, columns, provenance):
    """Provenance stands in front, as lines that begin with #."""
    with open(path, "w", encoding="utf-8", newline="") as out:
        for key, value in provenance.items():
            out.write("# %s: %s\n" % (key, value))
        writer = csv.writer(out)
        writer.writerow([key for key, _ in columns])
        for row in rows:
            writer.writerow(["" if row.get(key) is None else row.get(key) for key, _ in columns])


def read_csv(path):
    with open(path, encoding="utf-8") as stored:
        return list(csv.DictReader(line for line in stored if not line.startswith("#")))


def plot(path, script, data):
    """Runs a gnuplot script with `data` (name to rows of numbers) as its data blocks. None when gnuplot is not there."""
    if shutil.which("gnuplot") is None:
        print("bench: gnuplot is not installed (Debian: gnuplot-nox); no figure")
        return None
    blocks = []
    for name, rows in data.items():
        lines = "\n".join(" ".join('"%s"' % item if isinstance(item, str) else "%.9g" % item for item in row) for row in rows)
        blocks.append("$%s << END_OF_BLOCK\n%s\nEND_OF_BLOCK\n" % (name, lines))
    head = "set terminal svg size 860,560 font 'sans,13' background 'white'\nset output '%s'\n" % os.path.basename(path)
    done = subprocess.run(["gnuplot"], input=head + "".join(blocks) + script, text=True, capture_output=True,
                          cwd=os.path.dirname(path))
    if done.returncode != 0:
        raise RuntimeError("gnuplot: " + done.stderr.strip())
    return path


def write_page(path, title, sections, provenance):
    """One HTML page without anything outside it. A section: heading, text, figures, (rows, columns)."""
    parts = ["<!doctype html><html lang='en'><meta charset='utf-8'><title>%s</title>" % html.escape(title),
             "<style>body{font:15px/1.5 sans-serif;max-width:980px;margin:2em auto;padding:0 1em;color:#222}"
             "table{border-collapse:collapse;font-size:13px}td,th{border:1px solid #ccc;padding:2px 7px;text-align:right}"
             "td:first-child,th:first-child{text-align:left}svg{max-width:100%;height:auto}</style>",
             "<h1>%s</h1>" % html.escape(title)]
    for heading, text, figures, (rows, columns) in sections:
        parts.append("<h2>%s</h2><p>%s</p>" % (html.escape(heading), html.escape(text)))
        for figure in figures:
            with open(figure, encoding="utf-8") as svg:
                content = svg.read()
            parts.append(content[content.index("<svg"):])
        parts.append("<table><tr>" + "".join("<th>%s</th>" % html.escape(name) for _, name in columns) + "</tr>")
        for row in rows:
            parts.append("<tr>" + "".join("<td>%s</td>" % html.escape(cell(row.get(key))) for key, _ in columns) + "</tr>")
        parts.append("</table>")
    parts.append("<h2>Where this comes from</h2><table>")
    parts += ["<tr><td>%s</td><td style='text-align:left'>%s</td></tr>" % (html.escape(k), html.escape(v)) for k, v in provenance.items()]
    parts.append("</table></html>\n")
    with open(path, "w", encoding="utf-8") as page:
        page.write("\n".join(parts))
