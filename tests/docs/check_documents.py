#!/usr/bin/env python3
"""Holds the documents against the tree: check_documents.py ROOT.

- Every file that a document names or links to is there.
- Every folder with sources has a line in docs/architecture.md, and the page which that line links to names it.
- Code that a page shows as taken from a file (```cpp FILE) stands in that file, comments and white space apart.
- Classes and functions that begin a row of a table stand in the files that the row names; so do the tests that it quotes.
- No test has a semicolon in its name: CTest would take what stands before it for the name, find no such test, and pass.
- Sentences of the map and of the pages are short, and use the field's words; so do the sources.
- The drawn flows are those that scripts/flow_pictures draws, and the files that they name are there.
"""
import pathlib
import re
import statistics
import subprocess
import sys

root = pathlib.Path(sys.argv[1]).resolve()
map_page = root / "docs" / "architecture.md"
pages = sorted((root / "docs" / "rooms").glob("*.md"))
documents = [*sorted(root.glob("*.md")), *sorted((root / "docs").glob("*.md")), *pages]
tops = "solver|collision|fracture|structure|apps|tests|benchmarks|scripts|docs|models|schemas|cmake|examples"
problems = []


def say(document, problem):
    problems.append(f"{document.relative_to(root)}: {problem}")


def without_code(text):
    return re.sub(r"^```.*?^```$", "", text, flags=re.S | re.M)


def exists(path):
    """Whether a path from the root is there; `*` stands for anything."""
    return any(root.glob(path.rstrip("/"))) if "*" in path else (root / path).exists()


def anchors(document):
    """What headings can be linked to as."""
    headings = re.findall(r"^#+ (.*)$", without_code(document.read_text()), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def check_paths(document):
    text = without_code(document.read_text())
    for path in re.findall(rf"`((?:{tops})/[\w./*\-]*)`", text):
        if not exists(path):
            say(document, f"names {path}, which is not there")
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        linked = (document.parent / file).resolve() if file else document
        if not linked.exists():
            say(document, f"links to {target}, which is not there")
        elif anchor and anchor not in anchors(linked):
            say(document, f"links to {target}, where no heading is called so")


def rooms():
    """Folders that sources lie in, from the root, without the public headers'."""
    found = set()
    for top in ("solver", "collision", "fracture", "structure", "apps"):
        for file in (root / top).rglob("*"):
            folder = file.parent.relative_to(root)
            if file.suffix in (".cpp", ".h", ".inl", ".js", ".py") and not {"include", "node_modules"} & set(folder.parts):
                found.add(f"{folder.as_posix()}/")
    return found


def check_rooms():
    listed = {}
    for line in re.findall(r"^\|.*$", map_page.read_text(), re.M):
        page = re.search(r"\]\((rooms/[\w\-]+\.md)\)", line)
        for room in re.findall(rf"`((?:{tops})/[\w/]*/|fracture/)`", line):
            listed[room] = page and page.group(1)
    for room in sorted(rooms()):
        page = listed.get(room)
        if not page or not (root / "docs" / page).exists():
            say(map_page, f"no line for {room} with a link to its page")
        elif f"`{room}" not in (root / "docs" / page).read_text():
            say(root / "docs" / page, f"does not name {room}")
    for page in pages:
        if f"rooms/{page.name}" not in map_page.read_text():
            say(page, "is not linked to from docs/architecture.md")


def bare(code):
    """Code without comments and white space."""
    return re.sub(r"\s+", "", re.sub(r"//[^\n]*", "", code))


def check_excerpts(page):
    for path, code in re.findall(r"^```cpp (\S+)\n(.*?)^```$", page.read_text(), re.S | re.M):
        if not (root / path).exists():
            say(page, f"shows code of {path}, which is not there")
            continue
        source, at = bare((root / path).read_text()), 0
        for piece in re.split(r"^\s*\.\.\.\s*$", code, flags=re.M):
            found = source.find(bare(piece), at)
            if found < 0:
                say(page, f"shows code that {path} does not have: {piece.strip().splitlines()[0]}")
                break
            at = found + len(bare(piece))


def check_names(page):
    for line in re.findall(r"^\|.*$", page.read_text(), re.M):
        files = [root / path for path in re.findall(rf"`((?:{tops})/[\w/.\-]+\.(?:h|cpp|py|js))`", line)]
        sources = " ".join(file.read_text() for file in files if file.exists())
        for name in re.findall(r"`([A-Za-z_]\w*)(?:\(\))?`", line.split("|")[1]):
            if files and not re.search(rf"\b{name}\b", sources):
                say(page, f"says that {name} is in {', '.join(str(file.relative_to(root)) for file in files)}")


def check_tests(page):
    for line in re.findall(r"^\|.*$", page.read_text(), re.M):
        files = re.findall(r"`(tests/[\w/]+\.cpp)`", line)
        if not files:
            continue
        texts = [re.sub(r'"\s*\n\s*"|(?<=TEST_CASE\()\s+', "", (root / file).read_text())
                 for file in files if (root / file).exists()]
        for name in re.findall(r'"([^"]+)"', line):
            if not any(f'TEST_CASE("{name}"' in text for text in texts):
                say(page, f"names the test \"{name}\", which {', '.join(files)} does not have")


def check_test_names():
    for file in sorted((root / "tests").rglob("*.cpp")):
        text = re.sub(r'"\s*\n\s*"|(?<=TEST_CASE\()\s+', "", file.read_text())
        for name in re.findall(r'TEST_CASE\("([^"]*;[^"]*)"', text):
            say(file, f"has a semicolon in the name of the test \"{name}\", which CTest does not run then")


def sentences(document):
    """Sentences as lists of words: of paragraphs and lists; headings, tables, code and pictures are none."""
    text = without_code(document.read_text())
    text = re.sub(r"^(#|\||<|!\[|    ).*$", "", text, flags=re.M)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`]*`", "Code", text)
    paragraphs = re.split(r"\n\s*\n|\n\s*(?:[-*]|\d+\.) ", text)
    found = []
    for paragraph in paragraphs:
        joined = " ".join(paragraph.split())
        for sentence in re.split(r"(?<![ (][A-Z])(?<=[.!?])[)\"*]*\s+(?=[A-Z\"(*])", joined):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if words:
                found.append(words)
    return found


def check_sentences(document, most_long=0.10, long=30, middle=13):
    lengths = [len(words) for words in sentences(document)]
    if not lengths:
        return
    share = sum(length > long for length in lengths) / len(lengths)
    if share > most_long:
        say(document, f"{100 * share:.0f} % of its sentences have more than {long} words; at most {100 * most_long:.0f} %")
    if statistics.median(lengths) > middle:
        say(document, f"half of its sentences have more than {statistics.median(lengths):.0f} words; at most {middle}")


# Words of ours for what the field calls otherwise (docs/glossary.md): in documents, and in sources of the libraries and programs.
not_said = r"blows?|ladder|rungs?|restricted answers?|standing factor|hubs?|knocks?|giving edges?|felt contacts?|scatter map|hand over"


def check_words(document):
    prose = re.sub(r'`[^`]*`|"[^"\n]*"', "", without_code(document.read_text()))
    for word in sorted(set(re.findall(rf"\b(?:{not_said})\b", prose, re.I))):
        say(document, f"says \"{word}\" in its text; docs/glossary.md has the field's word")


def check_words_of_sources():
    for top in ("solver", "collision", "fracture", "structure", "apps"):
        for source in sorted((root / top).rglob("*")):
            if source.suffix not in (".h", ".cpp"):
                continue
            for word in sorted(set(re.findall(rf"\b(?:{not_said}|hand_over)\b", source.read_text(), re.I))):
                say(source, f"says \"{word}\"; docs/glossary.md has the field's word")


def check_flows():
    drawn = subprocess.run([root / "scripts" / "flow_pictures", "--check", root / "docs" / "pictures"], capture_output=True, text=True)
    if drawn.returncode:
        problems.append(drawn.stderr.strip())
    for name in ("step", "analysis"):
        picture = root / "docs" / "pictures" / f"{name}.svg"
        for path in re.findall(r'class="file"[^>]*>([^<]+)<', picture.read_text()):
            if not exists(path):
                say(picture, f"names {path}, which is not there")


for document in documents:
    check_paths(document)
check_rooms()
for page in (map_page, *pages):
    check_excerpts(page)
    check_names(page)
    check_tests(page)
    check_sentences(page)
    check_words(page)
check_names(root / "docs" / "glossary.md")
check_test_names()
check_words_of_sources()
check_flows()
if map_page.read_text().count("\n") > 120:
    say(map_page, "is longer than 120 lines: what it tells belongs on a page")

lengths = [len(words) for page in (map_page, *pages) for words in sentences(page)]
print("\n".join(problems) or f"{len(documents)} documents, {len(pages)} pages, {len(lengths)} sentences of the pages: "
      f"median {statistics.median(lengths):.0f} words, {100 * sum(n > 30 for n in lengths) / len(lengths):.1f} % above 30")
sys.exit(1 if problems else 0)
