"""Tables on the terminal, CSV, gnuplot figures and the one page that holds them all."""

import csv
import glob
import html
import json
import os
import re
import shutil
import statistics
import subprocess
import time


MARK = ".written-by-bench"  # in a folder of results: a later run may replace it


def may_replace(folder, known=False):
    """Whether a folder is new, empty, or one of results. `known`: the project's own place for them."""
    return known or not os.path.exists(folder) or (os.path.isdir(folder) and (not os.listdir(folder) or os.path.exists(os.path.join(folder, MARK))))


def fresh_folder(folder):
    """The folder, empty but for its mark. Only for one that may be replaced."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    with open(os.path.join(folder, MARK), "w", encoding="utf-8"):
        pass


def progress(context, text):
    print("bench: %5.0f s  %s" % (time.time() - context.start, text), flush=True)


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


def write_results(context, name, rows, columns, keys, lines=()):
    """NAME.csv and NAME.json: the same rows, each with the provenance of the run. `keys`: columns that tell rows apart, for a later
    comparison; `lines`: what was asked and what was measured, in words."""
    for told in lines:
        context.lines.append(told)
    write_csv(os.path.join(context.results, name + ".csv"), rows, columns, context.provenance)
    kept = [key for key, _ in columns]
    stored = {"name": name, "provenance": context.provenance, "machine": context.machine, "keys": list(keys), "lines": list(lines),
              "columns": {key: title for key, title in columns}, "rows": [{key: row.get(key) for key in kept} for row in rows]}
    with open(os.path.join(context.results, name + ".json"), "w", encoding="utf-8") as out:
        json.dump(stored, out, indent=1)
        out.write("\n")


def read_results(path):
    with open(path, encoding="utf-8") as stored:
        return json.load(stored)


LOGARITHMIC = "set logscale xy\nset format y '10^{%L}'\nset format x '10^{%L}'\nset grid\n"


def plot(path, script, data):
    """Runs a gnuplot script on logarithmic axes with `data` (name to rows of numbers) as its data blocks. None when gnuplot is not there."""
    if shutil.which("gnuplot") is None:
        print("bench: gnuplot is not installed (Debian: gnuplot-nox); no figure")
        return None
    blocks = []
    for name, rows in data.items():
        lines = "\n".join(" ".join('"%s"' % item if isinstance(item, str) else "%.9g" % item for item in row) for row in rows)
        blocks.append("$%s << END_OF_BLOCK\n%s\nEND_OF_BLOCK\n" % (name, lines))
    head = "set terminal svg size 860,560 font 'sans,13' background 'white'\nset output '%s'\n" % os.path.basename(path)
    done = subprocess.run(["gnuplot"], input=head + LOGARITHMIC + "".join(blocks) + script, text=True, capture_output=True,
                          cwd=os.path.dirname(path))
    if done.returncode != 0:
        raise RuntimeError("gnuplot: " + done.stderr.strip())
    return path


def sign_figure(path, provenance):
    """Says in a figure where it comes from, unless it does already."""
    with open(path, encoding="utf-8") as svg:
        content = svg.read()
    if "<metadata>" in content:
        return
    told = html.escape("".join("%s: %s\n" % item for item in provenance.items()))
    opened = re.search(r"<svg\b[^>]*>", content).end()
    with open(path, "w", encoding="utf-8") as svg:
        svg.write(content[:opened] + "\n<metadata>" + told + "</metadata>" + content[opened:])


def sign_figures(context):
    for path in sorted(glob.glob(os.path.join(context.results, "*.svg"))):
        sign_figure(path, context.provenance)


def quartiles(values):
    """Lower and upper quartile of repeated runs."""
    if len(values) < 2:
        return values[0], values[0]
    cuts = statistics.quantiles(values, n=4, method="inclusive")
    return cuts[0], cuts[2]


STYLE = ("body{font:15px/1.5 system-ui,sans-serif;max-width:1280px;margin:2em auto;padding:0 1em;color:#222;background:#fff}"
         "h2{margin-top:2.2em;border-bottom:1px solid #ddd}table{border-collapse:collapse;font-size:12px;margin:1em 0}"
         "td,th{border:1px solid #ccc;padding:2px 5px;text-align:right}th{background:#f4f4f4}"
         "p,li{max-width:68em}td{white-space:nowrap}td.note{white-space:normal;min-width:11em;text-align:left}th{vertical-align:bottom}td:first-child,th:first-child,.text,th.note{text-align:left}.wide{overflow-x:auto}svg{max-width:100%;height:auto}"
         "nav a{margin-right:1em}li{margin:.2em 0}")


FOLDED_FROM = 30  # rows: longer tables are opened by the reader


def _readable(rows, columns):
    """Columns that say something; notes stand in front, where nobody misses them."""
    shown = [column for column in columns if any(row.get(column[0]) not in (None, "") for row in rows)]
    notes = [column for column in shown if column[0] == "note"]
    shown = [column for column in shown if column[0] != "note"]
    names = next((i for i, (key, _) in enumerate(shown) if not all(isinstance(row.get(key), (str, type(None))) for row in rows)), len(shown))
    return shown[:names] + notes + shown[names:]


def _table(rows, columns):
    columns = _readable(rows, columns)
    text = {key for key, _ in columns if all(isinstance(row.get(key), (str, type(None))) for row in rows)}
    mark = lambda key: " class='note'" if key == "note" else " class='text'" if key in text else ""
    folded = len(rows) >= FOLDED_FROM
    lines = ["<details><summary>All %d rows</summary>" % len(rows)] if folded else []
    lines += ["<div class='wide'><table><tr>" + "".join("<th%s>%s</th>" % (mark(key), html.escape(name)) for key, name in columns) + "</tr>"]
    for row in rows:
        lines.append("<tr>" + "".join("<td%s>%s</td>" % (mark(key), html.escape(cell(row.get(key)))) for key, _ in columns) + "</tr>")
    return lines + ["</table></div>" + ("</details>" if folded else "")]


def _figure(path, number):
    """The picture itself; names inside it are made its own, since one page holds many."""
    with open(path, encoding="utf-8") as svg:
        content = svg.read()
    content = content[content.index("<svg"):]
    names = sorted(set(re.findall(r'\bid="([^"]+)"', content)), key=len, reverse=True)
    for name in names:
        for before, after in (('id="', '"'), ('href="#', '"'), ("href='#", "'"), ("url(#", ")")):
            content = content.replace(before + name + after, before + "f%d-" % number + name + after)
    return content


def write_page(path, title, sections, context, worse=None):
    """One HTML page without anything outside it. A section: heading, text, figures, (rows, columns). `worse`: what a comparison with an
    earlier run has found; None when there was none."""
    parts = ["<!doctype html><html lang='en'><head><meta charset='utf-8'><title>%s</title><style>%s</style></head><body><h1>%s</h1>"
             % (html.escape(title), STYLE, html.escape(title))]
    parts.append("<nav>" + "".join("<a href='#s%d'>%s</a>" % (i, html.escape(section[0])) for i, section in enumerate(sections)) + "</nav>")
    if context.lines:
        parts.append("<h2>Asked and measured</h2><ul>" + "".join("<li>%s</li>" % html.escape(line) for line in context.lines) + "</ul>")
    if worse is not None:
        parts.append("<h2>Against an earlier run</h2><ul>%s</ul>"
                     % ("".join("<li>%s</li>" % html.escape(line) for line in worse) or "<li>nothing is worse beyond the noise</li>"))
    number = 0
    for i, (heading, text, figures, (rows, columns)) in enumerate(sections):
        parts.append("<h2 id='s%d'>%s</h2><p>%s</p>" % (i, html.escape(heading), html.escape(text)))
        for figure in figures:
            parts.append(_figure(figure, number))
            number += 1
        parts += _table(rows, columns)
    origin = [{"what": key, "value": str(value)} for key, value in list(context.provenance.items()) + list(context.machine.items())]
    parts.append("<h2>Where this comes from</h2>")
    parts += _table(origin, [("what", "what"), ("value", "value")])
    parts.append("</body></html>\n")
    with open(path, "w", encoding="utf-8") as page:
        page.write("\n".join(parts))
