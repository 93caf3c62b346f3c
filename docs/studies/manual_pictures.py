"""Pictures of docs/gallery.md and of the tutorial: every deck is run, and one of its pictures is reduced.

    python docs/studies/manual_pictures.py [NAME ...] [--out docs/images]

NAME is that of a deck in examples/, or `tutorial`. Without a name all are made, in some five minutes. A deck
without PLOT is drawn at its end, with its contact forces.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from support.page_runner import fenced_blocks, run_command

from udec_ia import Model

WIDTH = 800  # pixels
CHOSEN = {"collapse": "collapse-plot-4", "ball-rolling": "ball-rolling-plot-1", "gravity-dam": "gravity-dam-plot-1", "shattering-block": "shattering-block-plot-3"}
LESSONS = {
    "1-first-blocks": {"floor-plot-1": "tutorial-floor"},
    "2-jointed-rock": {"tunnel-plot-1": "tutorial-tunnel", "bolted-plot-1": "tutorial-bolted"},
    "3-deformable-blocks": {"zones-plot-1": "tutorial-zones"},
    "5-own-slope": {"slope-fos-1": "tutorial-slope"},
}


def reduced(picture: Path, file: Path) -> None:
    """Write the picture with the width of a page and 256 colours."""
    with Image.open(picture) as image:
        whole = image.convert("RGB")
        size = (WIDTH, round(whole.height * WIDTH / whole.width))
        whole.resize(size, Image.Resampling.LANCZOS).quantize(256, kmeans=1, dither=Image.Dither.NONE).save(file, optimize=True)
    print(f"{file.relative_to(ROOT)}: {file.stat().st_size / 1000:.0f} kB", flush=True)


def example(name: str, folder: Path) -> Path:
    """The picture of an example, which is run in `folder`."""
    m = Model(out=folder, name=name)
    m.tell = m.inform = lambda text: None
    m.run(str(ROOT / "examples" / f"{name}.dat"), stream=io.StringIO())
    found = sorted(folder.glob("*-plot-*.png"), key=lambda path: path.stat().st_mtime) or [*folder.glob("*-fos-*.png")]
    if name in CHOSEN:
        return next(path for path in found if path.stem == CHOSEN[name])
    return found[-1] if found else m.plot(0, contacts=True)[0]


def lessons(folder: Path, out: Path) -> None:
    """The pictures of the tutorial, whose decks are taken from its pages."""
    with contextlib.chdir(folder):
        for page, pictures in LESSONS.items():
            decks = [block for block in fenced_blocks(ROOT / "docs" / "tutorial" / f"{page}.md") if block.language == "deck"]
            for block in decks:
                Path(block.name).write_text(block.text)
            for block in decks:
                if block.name != "rock.dat":
                    run_command(f"udec run {block.name} --out out")
            for made, name in pictures.items():
                reduced(Path("out") / f"{made}.png", out / f"{name}.png")


def main() -> None:
    """Make the pictures that are named, or all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images")
    given = parser.parse_args()
    out = given.out.resolve()
    (out / "gallery").mkdir(exist_ok=True)
    names = given.names or ["tutorial", *(path.stem for path in sorted((ROOT / "examples").glob("*.dat")))]
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            if name == "tutorial":
                lessons(Path(folder), out)
            else:
                reduced(example(name, Path(folder)), out / "gallery" / f"{name}.png")


if __name__ == "__main__":
    main()
