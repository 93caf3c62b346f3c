"""Hooks of mkdocs.yml: links to files outside docs/, and equations without a script.

Pages link to files of the checkout, such as ../README.md and ../examples/collapse.dat, as GitHub shows them.
The site has a copy of each such file in the folder `checkout`, and the links lead there. Equations between
dollars become MathML, which browsers draw themselves, so the site also works without a network.

WrappedMethods is an extension of griffe, which reads the sources for docs/api.md: methods of Model that are
made by a wrapper are attributes in the source, so their signatures and docstrings come from the class itself.
"""

from __future__ import annotations

import html
import inspect
import os
import posixpath
import re
from pathlib import Path
from typing import Any

import griffe
from latex2mathml.converter import convert
from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[1]
COPIES = "checkout"  # the folder of the site for files from outside docs/
LINK = re.compile(r"(?<=\]\()([^)#:\s]+)(?=[)#])")
WITHOUT_TYPES = {"warn_missing_types": False, "warn_unknown_params": False}  # of keywords such as `words`
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

    return LINK.sub(link_in_site, markdown)


def on_page_content(page_html: str, **_: Any) -> str:
    """Turn equations into MathML."""

    def mathml(found: re.Match[str]) -> str:
        formula = html.unescape(found[2]).strip()[2:-2]
        return str(convert(formula, display="inline" if found[1] == "span" else "block"))

    return EQUATION.sub(mathml, page_html)


class WrappedMethods(griffe.Extension):
    """Turns attributes of the class Model that are methods into methods."""

    def on_class_members(self, *, cls: griffe.Class, **_: Any) -> None:
        """Replace such attributes of `cls` when its source has been read."""
        if cls.path != "udec_ia.model.model.Model":
            return
        from udec_ia import Model

        for name, member in [*cls.members.items()]:
            method = getattr(Model, name, None)
            if member.is_attribute and not name.startswith("_") and inspect.isfunction(method):
                signature = inspect.signature(method)
                given = [*signature.parameters.values()][1:]
                parameters = griffe.Parameters(*map(parameter, given))
                made = griffe.Function(name, lineno=member.lineno, parameters=parameters)
                made.docstring = griffe.Docstring(
                    inspect.getdoc(method) or "", parent=made, parser="numpy", parser_options=WITHOUT_TYPES
                )
                cls.set_member(name, made)


def parameter(one: inspect.Parameter) -> griffe.Parameter:
    """A parameter as griffe has it."""
    default = None if one.default is one.empty else repr(one.default)
    annotation = None if one.annotation is one.empty else str(one.annotation)
    kind = griffe.ParameterKind[one.kind.name.lower()]
    return griffe.Parameter(one.name, annotation=annotation, kind=kind, default=default)
