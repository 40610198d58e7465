"""hostile_names.py TOPPLE [VIEWER]: pages of a building whose names, titles and labels are HTML.

Whatever a file calls its parts, a page shows it as text: no element, attribute or script comes of it. report.html, study.html and
the viewer's replay are written for names that a browser would take for elements, and for plain ones of the same number. Read as a
browser reads them both must have the same elements; where there is a Chromium, it must have them after the page's script too, on
the screen and in print, and must not have run what the names ask for.
"""
import html.parser, json, pathlib, re, shutil, subprocess, sys, tempfile

NAMES = ["<img src=x onerror=document.title='owned'>", "</script><script>document.title='owned'</script>", "\"><b id=owned>", "'><b id=owned>",
         "<!--<script>", "&lt;b id=owned&gt;", "</title><svg onload=document.title='owned'>", "${document.title='owned'}", "__proto__", "]]><b id=owned>"]


def building(name):
    """A bay with everything that has a name; `name` makes one of a number."""
    w = [name(i) for i in range(20)]
    nodes = {w[0]: [0, 0, 0], w[1]: [0, 0, 4], w[2]: [6, 0, 4], w[3]: [6, 0, 0]}
    kind = {"section": w[4], "material": w[5], "joints": [w[6], w[6]], "groups": [w[12]]}
    return {"topple": 1, "title": w[7], "materials": {w[5]: {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 235e6}},
            "sections": {w[4]: {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
            "joints": {w[6]: {"capacity": {"force": [1e6, 1e6, 1e6], "moment": [1e5, 1e5, 1e5]}},
                       w[19]: {"capacity_per_length": {"tension": 4e5, "compression": 4e6, "shear_y": 4e5, "shear_z": 6e4}}},
            "nodes": nodes,
            "members": {w[8]: {"kind": "post", "nodes": [w[0], w[1]], **kind}, w[9]: {"kind": "post", "nodes": [w[3], w[2]], **kind},
                        w[10]: {"nodes": [w[1], w[2]], **kind}},
            "panels": {w[11]: {"nodes": [w[0], w[3], w[2], w[1]], "thickness": 0.1, "material": w[5], "joint": w[19]}},
            "supports": {w[0]: "fixed", w[3]: "fixed"},
            "loads": {w[13]: {"self_weight": 1}, w[14]: {"nodes": {w[1]: {"x": 2e5}}, "members": {w[10]: [{"uniform": {"z": -2000}}]}}},
            "combinations": {w[15]: {w[13]: 1.35, w[14]: 1.5}, w[16]: {w[13]: 1}}}


def study(name):
    w = [name(i) for i in range(20)]
    return {"topple": 1, "title": w[17], "base": {"model": "m.json", "analyse": []}, "seed": 1, "samples": 30,
            "vary": [{"name": w[18], "at": "/materials/" + w[5].replace("~", "~0").replace("/", "~1") + "/yield_strength", "uniform": [2e8, 3e8]},
                     {"name": w[2], "at": "/nodes/" + w[2].replace("~", "~0").replace("/", "~1") + "/0", "uniform": [5, 7]}],
            "record": {w[0]: "largest_use", w[1]: "weight"}, "collapse_if": {w[0]: {"above": 0.1}}}


def hostile(i):
    return NAMES[i % len(NAMES)] if i < len(NAMES) else f"{NAMES[i % len(NAMES)]} {i}"


def plain(i):
    return f"name {i}"


class Elements(html.parser.HTMLParser):
    """Each element with its attributes' names, as a list."""

    def __init__(self, text):
        super().__init__()
        self.all = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.all.append((tag, tuple(sorted(key for key, _ in attributes))))


def written(run, folder, name, viewer):
    """Page -> text, of one way to call things."""
    folder.mkdir()
    (folder / "m.json").write_text(json.dumps(building(name)))
    (folder / "t.json").write_text(json.dumps(study(name)))
    (folder / "s.json").write_text(json.dumps({"topple": 1, "title": name(3), "model": "m.json", "combination": name(16), "duration": 0.2,
                                               "events": [{"at": 0.05, "remove": {"members": [name(8)]}}]}))
    subprocess.run([run, "analyse", "m.json", "-o", "a", "--html", "--code", "en1993"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([run, "study", "t.json", "-o", "t", "--html"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    pages = {"report.html": folder / "a/report.html", "study.html": folder / "t/study.html"}
    if viewer:
        shown = subprocess.run([viewer, "s.json", "--headless", "--size", "64x64", "--at", "0.2", "--replay", "replay.html"], cwd=folder,
                               capture_output=True, text=True)
        if shown.returncode == 0:
            pages["replay.html"] = folder / "replay.html"
        else:
            print("no replay:", shown.stderr.strip())
    return pages


def after_script(chromium, page, mark):
    return subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--virtual-time-budget=20000",
                           "--dump-dom", page.absolute().as_uri() + mark], check=True, capture_output=True, text=True, timeout=300).stdout


def main():
    run, viewer = pathlib.Path(sys.argv[1]).absolute(), (pathlib.Path(sys.argv[2]).absolute() if len(sys.argv) > 2 else None)
    chromium = next((found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None)
    wrong = []
    with tempfile.TemporaryDirectory() as place:
        own, other = (written(run, pathlib.Path(place) / key, name, viewer) for key, name in (("hostile", hostile), ("plain", plain)))
        for page in own:
            texts = {"as written": (own[page].read_text(), other[page].read_text())}
            for mark in ("", "#print") if chromium else ():
                texts[f"in a browser {mark}"] = tuple(after_script(chromium, pages[page], mark) for pages in (own, other))
            for what, (text, same) in texts.items():
                elements, expected = Elements(text).all, Elements(same).all
                owned = [one for one in elements if any(key in ("onerror", "onload") for key in one[1])]
                owned += [m for m in re.findall(r"<title>owned|<b id=\"?owned", text)] if what != "as written" else []
                if owned or sorted(set(elements)) != sorted(set(expected)):
                    wrong.append(f"{page} {what}: {owned or sorted(set(elements) ^ set(expected))[:5]}")
                if "as written" in what and len(elements) != len(expected):
                    wrong.append(f"{page} {what}: {len(elements)} elements, with plain names {len(expected)}")
            print(page, len(texts), "ways")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
