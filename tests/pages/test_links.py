"""Links of README and docs lead somewhere, and README leads to every page."""

import re

import pytest

from benchmarks.docs.marks import DOCS, ROOT, pages

PAGES = [*pages(), ROOT / "CONTRIBUTING.md"]
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)


def anchors(text: str) -> set[str]:
    """Those that a page has, as GitHub makes them of headings."""
    found: dict[str, int] = {}
    for title in re.findall(r"^#+ (.+)$", CODE.sub("", text), re.MULTILINE):
        word = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        found[word] = found.get(word, 0) + 1
    return {f"{word}-{k}" if k else word for word, n in found.items() for k in range(n)}


def dead(page, text: str) -> list[str]:
    """Links of a page that lead nowhere."""
    wrong = []
    for link in LINK.findall(re.sub(r"`[^`\n]*`", "", CODE.sub("", text))):
        if re.match(r"https?:|mailto:", link):
            continue
        name, _, anchor = link.partition("#")
        there = page.parent / name if name else page
        if not there.exists() or (
            anchor and anchor not in anchors(text if not name else there.read_text("utf-8"))
        ):
            wrong.append(link)
    return wrong


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links(page):
    assert dead(page, page.read_text(encoding="utf-8")) == []


def test_readme_leads_to_every_page():
    links = LINK.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    assert [page.name for page in DOCS.glob("*.md") if f"docs/{page.name}" not in links] == []


def test_dead_links_are_found():
    page = DOCS / "theory.md"
    text = "# A b, `c`\n[x](#a-b-c) [y](#a) [z](none.md) [w](theory.md#bodies) [v](theory.md#no)\n"
    assert dead(page, text) == ["#a", "none.md", "theory.md#no"]
