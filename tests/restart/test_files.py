"""Files are put over files of their own kind only: all else is error 31 and stays as it is."""

from __future__ import annotations

import os
import socket
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import h5py
import pytest
from support.handmade_map import two_blocks
from support.mechanics_scenes import box, model

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.file_replacement import put_in_place
from udec_ia.restart import load, save

ROOT = Path(__file__).parents[2]
PNG = b"\x89PNG\r\n\x1a\n a picture"


def small(out: Path) -> Model:
    """Two blocks, one on the other."""
    m = model(*box(0, 1, 0, 2), d=0.01)
    m.out = out
    m.split(-1, 1, 2, 1)
    m.fix(0, 1, 0, 1)
    return m


def refused(write: Callable[[], object]) -> str:
    """What error 31 says, without what it is about."""
    with pytest.raises(UdecError) as caught:
        write()
    assert caught.value.number == 31
    assert caught.value.advice
    return caught.value.detail


def foreign_hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file["mine"] = 1.0


def cut_short(path: Path) -> None:
    data = save(two_blocks(), path).read_bytes()
    path.write_bytes(data[:-1])


def listening(path: Path) -> None:
    here = socket.socket(socket.AF_UNIX)
    os.chdir(path.parent)  # the name of a socket may have 108 characters
    here.bind(path.name)
    here.close()


def loop(path: Path) -> None:
    path.symlink_to(path.with_name("other"))
    path.with_name("other").symlink_to(path)


def terminal(path: Path) -> None:
    """A device that not even a program that tries can replace: its folder takes no files."""
    path.symlink_to(os.ttyname(os.openpty()[1]))


OTHERS: dict[str, tuple[Callable[[Path], object], str]] = {
    "deck": (lambda path: path.write_text("START\n"), "is not a restart file of udec_ia, and stays as it is"),
    "empty": (Path.touch, "is empty, and stays as it is"),
    "picture": (lambda path: path.write_bytes(PNG), "is not a restart file"),
    "hdf5": (foreign_hdf5, "is an HDF5 file, but not a restart file"),
    "broken": (cut_short, "is cut short"),
    "folder": (Path.mkdir, "is a folder"),
    "pipe": (lambda path: os.mkfifo(path), "is a device, a pipe or a socket"),
    "socket": (listening, "is a device, a pipe or a socket"),
    "device": (terminal, "is a device, a pipe or a socket"),
    "loop": (loop, "Too many levels of symbolic links"),
    "below a file": (lambda path: path.parent.rmdir() or path.parent.touch(), "Not a directory"),
}


@pytest.mark.parametrize("what", OTHERS)
def test_save_replaces_nothing_but_a_restart_file(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "out" / "run.h5"
    path.parent.mkdir()
    make, reason = OTHERS[what]
    make(path)
    before = [(name, name.lstat().st_mode, name.lstat().st_mtime_ns) for name in sorted(tmp_path.rglob("*"))]
    content = path.read_bytes() if path.is_file() else b""
    detail = refused(lambda: save(two_blocks(), path))
    assert detail.startswith(str(path))
    assert reason in detail
    assert before == [
        (name, name.lstat().st_mode, name.lstat().st_mtime_ns) for name in sorted(tmp_path.rglob("*"))
    ]
    assert content == (path.read_bytes() if path.is_file() else b"")


def test_save_follows_links_and_leaves_them(tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    link = tmp_path / "link.h5"
    link.symlink_to("far/run.h5")
    for deck in (["START"], ["START", "CYCLE 1"]):  # first a file that is not there yet, then one that is
        save(two_blocks(), link, deck)
        assert load(tmp_path / "far" / "run.h5").deck == deck
        assert link.is_symlink()
        assert [path.name for path in (tmp_path / "far").iterdir()] == ["run.h5"]


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o664])
def test_a_file_keeps_its_mode(mode: int, tmp_path: Path) -> None:
    path = save(two_blocks(), tmp_path / "run.h5")
    path.chmod(mode)
    number = path.stat().st_ino
    save(two_blocks(), path)
    assert path.stat().st_ino != number
    assert stat.S_IMODE(path.stat().st_mode) == mode


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root gives files away")
def test_a_file_keeps_its_owner(tmp_path: Path) -> None:
    path = save(two_blocks(), tmp_path / "run.h5")
    path.chmod(0o640)
    os.chown(path, 12345, 23456)
    save(two_blocks(), path)
    found = path.stat()
    assert (found.st_uid, found.st_gid, stat.S_IMODE(found.st_mode)) == (12345, 23456, 0o640)


def test_a_group_that_cannot_be_kept_loses_its_rights(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = save(two_blocks(), tmp_path / "run.h5")
    path.chmod(0o664)
    if os.geteuid() == 0:
        os.chown(path, -1, 23456)

    def forbidden(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "chown", forbidden)
    ours = path.stat().st_gid == os.getegid()
    save(two_blocks(), path)
    assert stat.S_IMODE(path.stat().st_mode) == (0o664 if ours else 0o604)


def test_what_is_read_only_stays(tmp_path: Path) -> None:
    path = save(two_blocks(), tmp_path / "run.h5", ["START"])
    path.chmod(0o444)
    assert "is read-only" in refused(lambda: save(two_blocks(), path))
    assert load(path).deck == ["START"]


def test_a_folder_that_is_made_is_told(tmp_path: Path) -> None:
    """It may be a mistyped one."""
    m, printed = small(tmp_path / "out"), []
    m.inform = printed.append
    m.save()
    m.save(tmp_path / "one.h5")
    assert printed == []
    made = tmp_path / "out" / "a" / "b"
    m.save(made / "one.h5")
    assert printed == [f"the folder {made} did not exist and was created"]


def test_no_folder_is_made_outside_that_for_files(tmp_path: Path) -> None:
    path = tmp_path / "a" / "one.h5"
    assert "outside the folder for files" in refused(lambda: small(tmp_path / "out").save(path))
    assert not path.parent.exists()


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert "Not a directory" in refused(lambda: small(tmp_path).save(tmp_path / "file" / "deeper" / "run.h5"))


@pytest.mark.parametrize("name", ["a\0b", "\ud800", "a" * 300])
def test_names_that_no_file_can_have(name: str, tmp_path: Path) -> None:
    """Wherever a user can give a name, a numbered error or that there is no such file."""
    m = small(tmp_path)
    refused(lambda: m.save(tmp_path / name))
    for restart in (m.restart, Model.restore):
        with pytest.raises(UdecError) as caught:
            restart(tmp_path / name)
        assert caught.value.number == 29
        str(caught.value).encode()
    with pytest.raises(OSError, match=r"No such file|File name too long"):
        m.run(tmp_path / name)
    with pytest.raises(UdecError) as caught:
        Model(constitutive=tmp_path / f"{name}.py")
    assert caught.value.number == 34
    m.out = tmp_path / name
    refused(m.save)
    refused(lambda: m.plot(0))
    m.history(1, "TIME")
    refused(lambda: m.cycle(1))
    refused(lambda: m.plot(history=True))
    assert m.h.ci is not None
    assert list(tmp_path.iterdir()) == []


def test_pictures_and_tables_replace_their_own_kind_only(tmp_path: Path) -> None:
    m = small(tmp_path)
    m.name = "wall"
    m.animate = True
    m.history(1, "TIME")
    m.cycle(2)
    m.plot(0)
    m.plot(history=True)
    m.stop()
    written = sorted(path.name for path in tmp_path.iterdir())
    assert written == [
        *("wall-history-1.png", "wall-history-1.svg", "wall-history.csv", "wall-history.h5"),
        *("wall-plot-1.png", "wall-plot-1.svg", "wall.gif"),
    ]
    for name in written:
        path = tmp_path / name
        own = path.read_bytes()
        put_in_place(path, own, force=False)
        path.write_text("START\nBLOCK 0 0 0 1 1 1 1 0\n")
        assert "stays as it is" in refused(lambda path=path, own=own: put_in_place(path, own))
        assert path.read_text().startswith("START\n")
    again, other = small(tmp_path), small(tmp_path)
    again.name = other.name = "wall"
    again.history(1, "TIME")
    assert "wall-history.csv exists" in refused(lambda: again.cycle(2))
    assert "wall-history-1.png exists" in refused(lambda: again.plot(history=True))
    assert "wall-plot-1.png exists" in refused(lambda: again.plot(0))
    other.animate = True
    other.cycle(2)
    assert "wall.gif exists" in refused(other.stop)
    assert {(tmp_path / name).read_text()[:6] for name in written} == {"START\n"}


FULL = """
import resource, sys
sys.path.insert(0, sys.argv[2])
from support.handmade_map import two_blocks
from udec_ia.errors import UdecError
from udec_ia.restart import save
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
try:
    save(two_blocks(), sys.argv[1])
except UdecError as error:
    print(error)
"""
OFTEN = """
import sys
sys.path.insert(0, sys.argv[2])
from support.handmade_map import two_blocks
from udec_ia.restart import load, save
array = two_blocks()
for i in range(12):
    save(array, sys.argv[1], [sys.argv[3], str(i)])
    deck = load(sys.argv[1]).deck
    assert deck[0] in "ab" and 0 <= int(deck[1]) < 12, deck
"""


def start(program: str, *arguments: str) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-c", program, *arguments]
    return subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )


def test_a_disk_that_is_full(tmp_path: Path) -> None:
    path = save(two_blocks(), tmp_path / "run.h5", ["START"])
    printed, _ = start(FULL, str(path), str(ROOT / "tests")).communicate(timeout=120)
    assert printed.startswith(f"error 31: file cannot be written: {path}: File too large\n")
    assert load(path).deck == ["START"]
    assert list(tmp_path.iterdir()) == [path]


def test_two_processes_save_under_one_name(tmp_path: Path) -> None:
    """Whoever comes last wins; the file is whole at every moment, and nothing is left beside it."""
    path = tmp_path / "run.h5"
    both = [start(OFTEN, str(path), str(ROOT / "tests"), name) for name in "ab"]
    for process in both:
        printed, _ = process.communicate(timeout=120)
        assert process.returncode == 0, printed
    assert load(path).deck[1] == "11"
    assert list(tmp_path.iterdir()) == [path]
