"""The colours of the kinds keep apart, also for those who do not see red, green or blue as others do.

A colour as it is seen by these is calculated by the matrices of Machado, Oliveira and Fernandes (2009) for
the severity 1, and two colours are compared by their distance in CIELAB (1976), where 2.3 can just be viewed.
"""

from __future__ import annotations

import re
from itertools import combinations

import numpy as np
import pytest

from udec_ia.reader.word_map import NAMES
from udec_ia.view.view_page import WEB

SEEN_AS = {
    "all": np.eye(3),
    "no red": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "no green": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "no blue": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = XYZ @ np.ones(3)
FAR = 15.0  # distance that kinds must keep which lie beside each other everywhere
NEAR = 8.0  # distance of any two
COMMON = ("block", "corner", "contact", "domain", "junk", "zone", "gridpoint", "sdef", "fdef")


def colours(scheme: str) -> dict[str, str]:
    """The custom properties of the style sheet, as they are for a light or a dark page."""
    light, dark = re.findall(r":root \{(.*?)\}", (WEB / "style.css").read_text(), re.S)
    text = light if scheme == "light" else light + dark
    return dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6});", text))


def linear(colour: str) -> np.ndarray:
    part = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)


def lab(colour: str, eye: np.ndarray) -> np.ndarray:
    part = XYZ @ np.clip(eye @ linear(colour), 0, 1) / WHITE
    f = np.where(part > (6 / 29) ** 3, np.cbrt(part), part * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def contrast(one: str, other: str) -> float:
    """Contrast of two colours as WCAG 2 has it."""
    high, low = sorted((float((XYZ @ linear(colour))[1]) for colour in (one, other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("eye", SEEN_AS)
def test_kinds_keep_apart(scheme: str, eye: str) -> None:
    found = colours(scheme)
    kinds = [name for name in NAMES if name in found and name != "unused"]  # which is hatched
    assert {*COMMON} < {*kinds}
    for one, other in combinations(kinds, 2):
        far = float(np.linalg.norm(lab(found[one], SEEN_AS[eye]) - lab(found[other], SEEN_AS[eye])))
        assert far > (FAR if one in COMMON and other in COMMON else NEAR), (one, other, far)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_can_be_read(scheme: str) -> None:
    found = colours(scheme)
    for name in ("ink", "muted", "link"):
        for ground in ("paper", "ground"):
            assert contrast(found[name], found[ground]) >= 4.5, (name, ground)
    assert contrast(found["fault"], found["paper"]) >= 3
