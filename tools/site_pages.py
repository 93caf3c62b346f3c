"""Hooks of mkdocs.yml: links to files outside docs/, and equations without a script.

Pages link to files of the checkout, such as ../README.md and ../examples/collapse.dat, as GitHub shows them.
The site has a copy of each such file in the folder `checkout`, and the links lead there. Equations between
dollars become MathML, which browsers draw themselves, so the site also works without a network.
"""

from __future__ import annotations

import html
import os
import posixpath
import re
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert
from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[1]
COPIES = "checkout"  # the folder of the site for files from outside docs/
LINK = re.compile(r"(?<=\]\()([^)#:\s]+)(?=[)#])")
IMAGE = re.compile(r'(?<=src=")(docs/[^"]+)')
EQUATION = re.compile(r'<(span|div) class="arithmatex">(.*?)</\1>', re.DOTALL)


def place_in_site(target: str) -> str:
    """The place in the site of a file or folder of the checkout."""
    return target.removeprefix("docs/") if target.startswith("docs/") else f"{COPIES}/{target}"


def linked_files(page: Path) -> set[str]:
    """The files of the checkout, outside docs/, to which a page leads."""
    found = {os.path.relpath(page.parent / link, ROOT) for link in LINK.findall(page.read_text())}
    return {one for one in found if not one.startswith(("docs", "..")) and (ROOT / one).is_file()}


def on_files(files: Any, config: Any) -> Any:
    """Add the files outside docs/ to the site, with those to which these lead."""
    left = set().union(*(linked_files(path) for path in (ROOT / "docs").rglob("*.md")))
    done: set[str] = set()
    while left:
        name = left.pop()
        done.add(name)
        files.append(File.generated(config, f"{COPIES}/{name}", abs_src_path=str(ROOT / name)))
        if name.endswith(".md"):
            left |= linked_files(ROOT / name) - done
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Turn links out of docs/ into links to the copies."""
    here = page.file.src_uri
    source = here.removeprefix(COPIES + "/") if here.startswith(COPIES) else f"docs/{here}"

    def link_in_site(found: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(posixpath.dirname(source), found[0]))
        if target.startswith("..") or not (ROOT / target).is_file():
            return found[0]
        return posixpath.relpath(place_in_site(target), posixpath.dirname(here) or ".")

    return IMAGE.sub(link_in_site, LINK.sub(link_in_site, markdown))


def on_page_content(page_html: str, **_: Any) -> str:
    """Turn equations into MathML."""

    def mathml(found: re.Match[str]) -> str:
        formula = html.unescape(found[2]).strip()[2:-2]
        return str(convert(formula, display="inline" if found[1] == "span" else "block"))

    return EQUATION.sub(mathml, page_html)
