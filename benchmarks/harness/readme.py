"""The README's figure and table of run time against error, from stored results: `scripts/bench --publish` stores them in docs/benchmarks."""

import os

import labels
import output

STORED = "precision_4x5x6.json"
FIGURE_FILE = "error_against_time.svg"
BEGIN, END = "<!-- table of scripts/bench -->", "<!-- end of the table -->"

# Rows of the table: what happens and the method in the stored result, and what the README calls it.
NOTHING, CHANGES, FIRST = "nothing", "a load at each step", "from nothing"
ROWS = [(NOTHING, "sequential impulse 10", "Bullet, sequential impulse, 10 iterations"), (NOTHING, "sequential impulse 50", "Bullet, 50 iterations"),
        (NOTHING, "sequential impulse 200", "Bullet, 200 iterations"), (NOTHING, "sequential impulse 1000", "Bullet, 1000 iterations"),
        (NOTHING, "sequential impulse 20 x 10", "Bullet, 20 substeps of 10"),
        (NOTHING, "conjugate gradient 50", "Bullet, conjugate gradient, 50"), (NOTHING, "Featherstone, tree", "Bullet, Featherstone's tree"),
        (NOTHING, "Topple, standing", "Topple, nothing changes"), (CHANGES, "Topple, standing", "Topple, a load changes at each step"),
        ("a joint breaks", "Topple, restricted", "Topple, a joint breaks, which is next"), (FIRST, "Topple, standing", "Topple, from nothing")]

FIGURE = """
set xlabel 'milliseconds a step, one thread'
set ylabel 'relative error of the reactions'
set key off
set xrange [%g:%g]
set yrange [%g:%g]
plot $labels using 4:5:($2-$4):($3-$5) with vectors nohead lw 0.4 lc rgb '#bbbbbb' notitle, \\
     $bullet using 2:3 with points pt 7 ps 1 lc rgb '#c0392b' notitle, \\
     $topple using 2:3 with points pt 5 ps 1.1 lc rgb '#2471a3' notitle, \\
     $labels using 2:3:1 with labels left font ',9' notitle
"""


def chosen(stored):
    """Pairs of the README's name and the stored row; rows that the run did not measure are left out."""
    found = {(row["load"], row["method"]): row for row in stored["rows"]}
    return [(name, found[load, method]) for load, method, name in ROWS if (load, method) in found and found[load, method].get("milliseconds")]


def number(value):
    """Two digits; powers of ten where a plain number would be long."""
    if value is None:
        return "-"
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return "%.2g" % value if abs(value) < 100 else "%d" % round(value)
    digits, power = ("%.1e" % value).split("e")
    return "%s·10<sup>%d</sup>" % (digits, int(power))


def table(stored):
    lines = ["| 4 x 5 posts, 6 storeys | ms a step | error of the sag | of the reactions | of the beams' moments |", "|---|---|---|---|---|"]
    for name, row in chosen(stored):
        name += " (still moves)" if "still moves" in (row.get("note") or "") else ""
        lines.append("| %s | %s | %s | %s | %s |" % (name, number(row["milliseconds"]), number(row["sag_error"]), number(row["reaction_error"]), number(row["beam_moment_error"])))
    origin = stored["provenance"]
    lines += ["", "Medians of one run on one thread of %s, beside other work (load %s at its start), commit %s, %s; [every number](docs/benchmarks/%s)."
              % (origin["processor"].replace("(R)", ""), origin["load_at_start"], origin["commit"][:7], origin["date"][:10], STORED)]
    return lines


def in_text(text, stored):
    """The README with the table anew. Raises ValueError where it has no place for it."""
    if BEGIN not in text or END not in text:
        raise ValueError("README.md has no lines %s and %s" % (BEGIN, END))
    before, rest = text.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    return before + BEGIN + "\n" + "\n".join(table(stored)) + "\n" + END + after


def figure(path, stored):
    data = {"bullet": [], "topple": []}
    for name, row in chosen(stored):
        block = "topple" if name.startswith("Topple") else "bullet"
        data[block].append((name.replace("Bullet, sequential impulse, 10 iterations", "Bullet, 10 iterations"), row["milliseconds"], max(1e-16, row["reaction_error"])))
    points = data["bullet"] + data["topple"]
    x_range, y_range = labels.decades([p[1] for p in points], above=1.5), (1e-16, 1e2)
    data["labels"] = labels.place(points, x_range, y_range)
    return output.plot(path, FIGURE % (x_range + y_range), data)


def publish(root, results):
    """Stores the results of a run in docs/benchmarks, and writes the README's figure and table from them. Whole runs alone may be published."""
    kept = os.path.join(root, "docs", "benchmarks")
    os.makedirs(kept, exist_ok=True)
    for name in sorted(os.listdir(results)):
        path = os.path.join(results, name)
        if name.endswith(".json") and "keys" in output.read_results(path):
            with open(path, encoding="utf-8") as source, open(os.path.join(kept, name), "w", encoding="utf-8") as copy:
                copy.write(source.read())
    stored = output.read_results(os.path.join(kept, STORED))
    drawn = figure(os.path.join(root, "docs", "pictures", FIGURE_FILE), stored)
    if drawn:
        output.sign_figure(drawn, stored["provenance"])
    readme = os.path.join(root, "README.md")
    with open(readme, encoding="utf-8") as text:
        new = in_text(text.read(), stored)
    with open(readme, "w", encoding="utf-8") as text:
        text.write(new)
    print("bench: docs/benchmarks, docs/pictures/%s and the table of README.md are those of this run" % FIGURE_FILE)
