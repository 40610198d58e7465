"""check_print.py CHROMIUM PAPER REPORT...: prints reports (PAPER: A4 or Letter) as a person would, and reads the PDF.

Every line of the contents must name the page on which its heading stands, every page but the cover must have its number, the
sheets that the page laid out must be as many as the pages, and the PDF must have bookmarks.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

SIZES = {"A4": (595, 842), "Letter": (612, 792)}  # points


def printed(chromium, report, paper, pdf):
    mark = "print" if paper == "A4" else "print-letter"
    subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", f"--print-to-pdf={pdf}", "--no-pdf-header-footer",
                    "--generate-pdf-document-outline", f"{pathlib.Path(report).absolute().as_uri()}#{mark}"],
                   check=True, capture_output=True, timeout=300)
    text = subprocess.run(["pdftotext", "-layout", str(pdf), "-"], check=True, capture_output=True, text=True).stdout
    return text.split("\f")[:-1]


def contents(pages):
    """[heading, page] as the contents have them: from the second page up to the first chapter's."""
    lines = []
    for page in pages[1:]:
        if page.strip().startswith("1. Summary"):
            return lines
        lines += [(m[1], int(m[2])) for m in re.finditer(r"^ *(\S.*?) {2,}(\d+)$", page, re.M)]
    raise AssertionError("no summary was found behind the contents")


def on_page(title, page):
    """A member's part is named shortly in the contents: NAME, SECTION stands for a heading that begins with "NAME: "."""
    wanted = title if re.match(r"\d+\. ", title) or "," not in title else title.split(",")[0] + ":"
    return re.search(r"^ *" + re.escape(re.sub(r"\s+", " ", wanted)), re.sub(r"[^\S\n]+", " ", page), re.M)


def check(chromium, report, paper):
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        pdf = pathlib.Path(folder) / "report.pdf"
        pages = printed(chromium, report, paper, pdf)
        size = re.search(r"Page size: +([\d.]+) x ([\d.]+)", subprocess.run(["pdfinfo", str(pdf)], check=True, capture_output=True, text=True).stdout)
        if [round(float(v)) for v in size.groups()] != list(SIZES[paper]):
            failures.append(f"the paper is {size[0]}")
        if b"/Outlines" not in pdf.read_bytes():
            failures.append("no bookmarks")
    lines = contents(pages)
    if len(lines) < 10:
        failures.append(f"the contents have only {len(lines)} lines")
    for title, number in lines:
        if not 1 <= number <= len(pages) or not on_page(title, pages[number - 1]):
            failures.append(f"{title} is not on page {number}")
    for number, page in enumerate(pages[1:], 2):
        if f"{number} of {len(pages)}" not in page:
            failures.append(f"page {number} does not have its number")
        if len(page.split()) < 8 and not re.search(r"[A-Za-z]{4}", page.replace("Topple", "")):
            failures.append(f"page {number} is empty")
    print(f"{report}, {paper}: {len(pages)} pages, {len(lines)} lines in the contents, {len(failures)} failures")
    return failures


failed = [failure for report in sys.argv[3:] for failure in check(sys.argv[1], report, sys.argv[2])]
print("\n".join(failed))
sys.exit(bool(failed))
