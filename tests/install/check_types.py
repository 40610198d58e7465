"""No two classes or structs of the libraries and programs share a name in a namespace: where one program has both, the
linker would take either's copy of what the compiler makes for them (constructors, containers of them), without a word.

check_types.py SOURCE_FOLDER"""
import collections
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
where = collections.defaultdict(set)
for folder in ("solver", "collision", "fracture", "structure", "apps"):
    for path in (source / folder).rglob("*"):
        if path.suffix not in (".h", ".cpp", ".inl"):
            continue
        namespace, private = "", False
        for line in path.read_text(encoding="utf-8").splitlines():
            if opened := re.match(r"namespace ([\w:]+) \{", line):
                namespace = opened[1]
            elif line.startswith("namespace {"):
                private = True
            elif line == "}  // namespace":
                private = False
            elif (defined := re.match(r"(?:class|struct) (\w+)(?: final)?(?: : .*)? \{", line)) and not private:
                where[f"{namespace}::{defined[1]}"].add(str(path.relative_to(source)))
if len(where) < 500:
    sys.exit(f"only {len(where)} types were found: the sources are written otherwise than this test reads them")
twice = {name: files for name, files in where.items() if len(files) > 1}
for name, files in sorted(twice.items()):
    print(f"{name} is defined in each of {', '.join(sorted(files))}")
sys.exit(1 if twice else 0)
