"""How fast the program is, measured: cycles against a structure of arrays, SPLIT, and the ball.

    python tools/bench.py passes                                     everything
    python tools/bench.py passes cycle --blocks 1000 10000 100000    one of: cycle, zones, split, proof,
                                                                     change, laws, joints, water, ball

Times are processor time, so that other work on the machine disturbs them little; only the ball is timed
by the clock on the wall. Program and yardstick take turns of many cycles; the ratio is the median over the
turns.
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from time import perf_counter, process_time

import numpy as np
from numba import njit
from speed import array_zones
from speed.array_cycle import EVENTS, Slab, extract, run_soa
from speed.array_flow import compare as compare_flow
from speed.array_flow import wet_slab

from udec_ia import Model
from udec_ia.compiling.law_calls_numba import MATERIAL_SIZE, _jump
from udec_ia.heap.accessors import putr
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.heap_tools.convert_word_scheme import convert
from udec_ia.heap_tools.renumber_groups import arrange, renumber
from udec_ia.layout import offsets as g
from udec_ia.layout.offsets import CON1, CON2, DTOL, HTOL, KXD, KXDG, KYD, KYDG, NBLK, NCON, TDEL, UPEND
from udec_ia.ops.laws.law_file import read_laws
from udec_ia.reader.group_tables import table
from udec_ia.restart import load_to_change, save_changed
from udec_ia.running.history_series import run_unwatched

ROOT = Path(__file__).parents[2]
TURNS = 15
TRIES = 5  # slabs cut; the first may pay for memory that the machine hands out for the first time
PROOFS = 3
WORK = 2_000_000  # contacts or zones of one turn: in its first cycle caches hold what the other works on
SETTLE = 40  # cycles before a measurement
OVERLAP = 0.001  # that a slab is squeezed to at every joint, in rounding lengths
FAR = 1e9
RIGID = (None, None, None, None)  # what a run of rigid blocks needs beside them: nothing


def slab(blocks: int, skew: float = 0.0) -> Model:
    """A slab of about `blocks` unit blocks, cut by two joint sets; the second leans by `skew` a unit."""
    ny = round(math.sqrt(blocks / 1.2))
    nx = round(blocks / ny)
    model = Model()
    model.start()
    model.property(1, density=2000, kn=1e11, ks=1e11, friction=0.5)
    model.gravity(0, -10)
    model.damping(0.5, 10, "mass")
    model.block(0, 0, 0, ny, nx, ny, nx, 0)
    for j in range(1, ny):
        model.split(-1, j, nx + 1, j)
    for i in range(1, nx):
        model.split(i - skew, -1, i + skew * (ny + 1), ny + 1)
    return model


def squeeze(model: Model) -> None:
    """Load every contact: all blocks approach their common centre, then the outermost ones hold the rest."""
    h, rows = model.h, table(model.array, "block")
    xs, ys = rows["KX"], rows["KY"]
    middle = xs.mean(), ys.mean()
    model.free(-FAR, FAR, -FAR, FAR)
    h.cr[CON1] = h.cr[CON2] = 1
    rate = OVERLAP * float(h.cr[DTOL]) / float(h.cr[TDEL])
    for ib, x, y in zip(rows["address"], xs, ys, strict=True):
        putr(h, int(ib), KXD, -rate * float(x - middle[0]))
        putr(h, int(ib), KYD, -rate * float(y - middle[1]))
    run_unwatched(h, 1, RIGID)
    for frame in (
        (-FAR, xs.min() + 0.5, -FAR, FAR),
        (xs.max() - 0.5, FAR, -FAR, FAR),
        (-FAR, FAR, -FAR, ys.min() + 0.5),
        (-FAR, FAR, ys.max() - 0.5, FAR),
    ):
        model.fix(*map(float, frame))
    for ib in rows["address"]:
        putr(h, int(ib), KXD, 0.0)
        putr(h, int(ib), KYD, 0.0)
    model.cycle(SETTLE)


def throw(model: Model) -> None:
    """Free all blocks and give them one velocity so great that no domain pass can be skipped."""
    h = model.h
    model.free(-FAR, FAR, -FAR, FAR)
    speed = 2 * float(h.cr[HTOL] / h.cr[TDEL])
    h.cr[CON1] = h.cr[CON2] = 1
    for ib in table(model.array, "block")["address"]:
        putr(h, int(ib), KXD, speed)


def agree(model: Model, s: Slab) -> None:
    """Raise ValueError unless program and yardstick have come to the same state, to rounding."""
    if s.sums[EVENTS]:
        raise ValueError(f"void: {s.sums[EVENTS]:g} contacts had to change, which the yardstick cannot do")
    pairs = (
        ("block", s.blocks, "KX:x KY:y KXD:xd KYD:yd KTD:td KBFX:fx KBFY:fy KBFT:ft"),
        ("corner", s.corners, "KXP:x KYP:y KXCP:xc KYCP:yc KXDP:xd KYDP:yd"),
        ("contact", s.contacts, "KXC:x KYC:y KXDC:xd KYDC:yd KCS:us KCN:un KCFS:fs KCFN:fn"),
        ("domain", s.domains, "KUMAX:umax"),
    )
    for kind, arrays, names in pairs:
        rows = table(model.array, kind)
        for name in names.split():
            ours, theirs = name.split(":")
            a, b = rows[ours], getattr(arrays, theirs)
            difference = float(np.abs(a - b).max() / max(np.abs(a).max(), 1e-300))
            if difference > 1e-9:
                raise ValueError(f"void: {ours} of {kind} differs by {difference:.1e} of the greatest")


def turns(model: Model, s: Slab, cycles: int) -> tuple[float, float, float]:
    """ns per contact and cycle of the program and of the yardstick, and the median of their ratios."""
    contacts = int(model.h.ci[NCON])
    n = cycles or max(1, WORK // contacts)
    times = []
    for _ in range(TURNS):
        start = process_time()
        done = run_unwatched(model.h, n, RIGID)
        between = process_time()
        run_soa(s, n)
        times.append((between - start, process_time() - between))
        if done != n:
            raise ValueError("void: the program stopped before the last cycle")
    agree(model, s)
    heap, soa = np.array(times).T
    per = 1e9 / (n * contacts)
    return float(np.median(heap)) * per, float(np.median(soa)) * per, float(np.median(heap / soa))


STATES = {"at rest": None, "loaded": squeeze, "thrown": throw}


def bench_cycles(sizes: list[int], skew: float, cycles: int) -> None:
    """Whole cycles of slabs at rest, of loaded ones and of slabs that are thrown."""
    print("| blocks | contacts | slab | with force | domain pass | program, ns | arrays, ns | ratio |")
    print("|---|---|---|---|---|---|---|---|")
    for blocks in sizes:
        model = slab(blocks, skew)
        model.fix(-FAR, FAR, 0, 1)
        model.cycle(SETTLE)
        rest = model.array
        for name, prepare in STATES.items():
            model.session.array = rest.copy()
            if prepare is not None:
                prepare(model)
            run_unwatched(model.h, 2, RIGID)
            print(
                f"| {model.h.ci[NBLK]} | {model.h.ci[NCON]} | {name} | {measure(model, cycles)} |", flush=True
            )


def measure(model: Model, cycles: int) -> str:
    """The last columns of a line: share of loaded contacts, domain pass, times and ratio."""
    pace = "waits" if model.h.cr[UPEND] > 0 else "every cycle"
    loaded = float(np.mean(table(model.array, "contact")["KCFN"] > 0))
    s = extract(model.array)
    run_soa(s, 0)
    try:
        heap, soa, ratio = turns(model, s, cycles)
    except ValueError as void:
        return f"{loaded:.0%} | {void} | | | "
    return f"{loaded:.0%} | {pace} | {heap:.1f} | {soa:.1f} | {ratio:.2f}"


def plate(cells: int) -> Model:
    """A square block of `cells` squared cells of two zones each, above a base, its grid-points in unrest."""
    model = Model()
    model.start()
    model.property(1, density=2000, kn=1e9, ks=1e9, bulk=1e9, g=6e8)
    model.gravity(0, -10)
    model.damping(0.01, 1)
    model.round(0.1)
    model.block(0, -1, 0, cells, cells, cells, cells, -1)
    model.split(-1, 0, cells + 1, 0)
    model.fix(0, cells, -1, 0)
    row = cells + 1
    points = [(float(i), float(j)) for j in range(row) for i in range(row)]
    first = [j * row + i + 1 for j in range(cells) for i in range(cells)]
    triangles = [zone for k in first for zone in ((k, k + row, k + 1), (k + 1, k + row, k + row + 1))]
    model.change(0, cells, 0, cells, "fdef")
    model.generate(0, cells, 0, cells, "manual", gridpoints=points, zones=triangles)
    model.cycle(1)
    unrest = np.random.default_rng(1).normal(size=(row * row, 2)) * 1e-3
    for ig, (xd, yd) in zip(table(model.array, "gridpoint")["address"], unrest, strict=True):
        putr(model.h, int(ig), KXDG, float(xd))
        putr(model.h, int(ig), KYDG, float(yd))
    return model


def bench_zones(sizes: list[int]) -> None:
    """The pass of a fully-deformable block against the same arithmetic over a structure of arrays."""
    print("| zones | program, ns a zone | arrays, ns a zone | ratio |\n|---|---|---|---|")
    for size in sizes:
        model = plate(round(math.sqrt(size / 2)))
        (ib,) = (int(row["address"]) for row in table(model.array, "block") if row["KBEX"])
        body = array_zones.extract(model.array)
        count = len(body.zones.a)
        n, times = max(1, WORK // count), []
        array_zones.run_arrays(body, 0)
        array_zones.run_heap(model.h, ib, 0)
        for _ in range(TURNS):
            start = process_time()
            array_zones.run_heap(model.h, ib, n)
            between = process_time()
            array_zones.run_arrays(body, n)
            times.append((between - start, process_time() - between))
        heap, arrays = np.array(times).T * 1e9 / (n * count)
        line = f"{np.median(heap):.1f} | {np.median(arrays):.1f} | {np.median(heap / arrays):.2f}"
        print(f"| {count} | {same_zones(model, body) or line} |", flush=True)


def same_zones(model: Model, body: array_zones.Body) -> str:
    """Nothing if program and yardstick have come to the same stresses and places, to rounding."""
    for kind, arrays, names in (
        ("gridpoint", body.points, "KXG:x KYG:y KXDG:xd KYDG:yd KGFX:fx KGFY:fy"),
        ("zone", body.zones, "KZS11:s11 KZS12:s12 KZS22:s22"),
    ):
        rows = table(model.array, kind)
        for ours, theirs in (name.split(":") for name in names.split()):
            a, b = rows[ours], getattr(arrays, theirs)
            if not np.abs(a - b).max() <= 1e-9 * np.abs(a).max():
                return f"void: {ours} differs | | "
    return ""


def bench_split(sizes: list[int]) -> None:
    """Cutting slabs by SPLIT. Targets: 30,000 blocks in 10 s; at 300,000 half as much again per block."""
    slab(100)
    print("| blocks cut by SPLIT | s | us per block |\n|---|---|---|")
    for blocks in sizes:
        times = []
        for _ in range(TRIES):
            start = process_time()
            n = int(slab(blocks).h.ci[NBLK])
            times.append(process_time() - start)
        seconds = float(np.median(times))
        print(f"| {n} | {seconds:.2f} | {seconds / n * 1e6:.1f} |", flush=True)


def bench_proof(sizes: list[int]) -> None:
    """What it takes to check a slab, and to bring it back by RESTART. Target: 100,000 blocks in 5 s each."""
    print("| blocks | check, s | RESTART, s | us per block |\n|---|---|---|---|")
    for blocks in sizes:
        model = slab(blocks)
        model.fix(-FAR, FAR, 0, 1)
        model.cycle(SETTLE)
        with tempfile.TemporaryDirectory() as folder:
            file = model.save(Path(folder) / "slab.h5")
            times = []
            for _ in range(PROOFS):
                start = process_time()
                violations = model.check()
                between = process_time()
                model.restart(file)
                times.append((between - start, process_time() - between))
        check, restart = np.median(times, axis=0)
        n = int(model.h.ci[NBLK])
        line = f"{check:.2f} | {restart:.2f} | {(check + restart) / n * 1e6:.1f}"
        print(f"| {n} | {violations or line} |", flush=True)


def bench_change(sizes: list[int]) -> None:
    """Reading a slab, making another state of it and writing that, as the restart-file tools do.

    Target: 100,000 blocks in 3 s; where reals change their width the new state is proved as well.
    """
    print("| blocks | change | read, s | changed, s | written, s | together |\n|---|---|---|---|---|---|")
    changes: dict[str, Callable[[MainArray], MainArray]] = {
        "convert to i64r64": lambda array: convert(array, scheme("i64r64")).array,
        "convert to i32r32": lambda array: convert(array, scheme("i32r32")).array,
        "renumber": lambda array: (renumber(array), array)[1],
    }
    for blocks in sizes:
        model = slab(blocks)
        model.cycle(SETTLE)
        with tempfile.TemporaryDirectory() as folder:
            file, to = model.save(Path(folder) / "slab.h5"), Path(folder) / "to.h5"
            for name, change in changes.items():
                times = []
                for _ in range(PROOFS):
                    clock = [process_time()]
                    state = load_to_change(file)
                    clock.append(process_time())
                    array = change(state.array)
                    clock.append(process_time())
                    save_changed(state, array, to, f"* {name}")
                    times.append(np.diff([*clock, process_time()]))
                read, changed, written = np.median(times, axis=0)
                line = f"{name} | {read:.2f} | {changed:.2f} | {written:.2f} | {read + changed + written:.2f}"
                print(f"| {int(model.h.ci[NBLK])} | {line} |", flush=True)


LAWS = {  # bodies of joint laws that look something up in a table of 100 numbers
    "interpolates": "x = abs(us); k = int(x); return (T[k] + (x - k) * (T[k + 1] - T[k])) * dun, m.ks * dus",
    "sums 100 up": "return sum([T[I[k]] for k in range(100)]) * dun, m.ks * dus",
}


@njit
def call_often(law: int, n: int, material: int) -> float:
    """Call the law at an address `n` times, as kernels do."""
    total = 0.0
    for i in range(n):
        total += _jump(law, (1e3, 1.0, 1e-9, 1e-9, 0.0, i % 90 + 0.5), material, (0.0, 0.0, 0.0))[0]
    return total


def bench_laws(calls: int = 500_000) -> None:
    """One call of a law that indexes, with bounds checks and without."""
    print("| law | checked, ns | not checked, ns | ratio |\n|---|---|---|---|")
    material = np.ones(MATERIAL_SIZE // 8)
    for name, body in LAWS.items():
        plain = f"def clj2(fn, fs, dun, dus, un, us, m):\n    {body}\n"
        laws, times = [], []
        for decorator in ("", "@njit(boundscheck=False)\n"):
            space = {"T": np.linspace(0.0, 1.0, 100), "I": np.arange(100), "njit": njit}
            exec(decorator + plain, space)
            laws.append(read_laws({"clj2": space["clj2"]})["clj2"])
        for _ in range(TURNS + 1):
            for law in laws:
                start = process_time()
                call_often(law.address, calls, material.ctypes.data)
                times.append((process_time() - start) / calls * 1e9)
        checked, unchecked = np.array(times[2:]).reshape(TURNS, 2).T
        ratio = np.median(checked / unchecked)
        print(f"| {name} | {np.median(checked):.1f} | {np.median(unchecked):.1f} | {ratio:.2f} |", flush=True)


def jointed(blocks: int, per_length: bool) -> Model:
    """A slab that stands in a trough, nearly at rest; its joints have a joint material, or none."""
    model = slab(blocks)
    n = int(model.table("block")["KX"].max()) + 1
    if per_length:
        model.jproperty(1, kn=1e11, ks=1e11, friction=0.5, between=(1, 1))
    model.fix(-FAR, FAR, 0, 1)
    model.fix(-FAR, 1, 0, FAR)
    model.fix(n - 1, FAR, 0, FAR)
    model.damping(local=0.8)
    model.cycle(1000)
    return model


def leaning(blocks: int, per_length: bool) -> Model:
    """Columns of ten bricks under tilted gravity, so that three joints in ten are partly open."""
    model, columns = Model(), blocks // 10
    wide = 1.5 * columns
    model.property(1, density=2000, kn=1e9, ks=1e9, friction=0.8)
    model.block(-1, -1, -1, 0, wide, 0, wide, -1)
    for k in range(10 * columns):
        x, y = k // 10 * 1.5, k % 10 * 0.5
        model.block(x, y, x, y + 0.5, x + 1, y + 0.5, x + 1, y)
    model.round(0.02)
    model.fix(-1, wide, -1, 0)
    if per_length:
        model.jproperty(1, kn=1e9, ks=1e9, friction=0.8, between=(1, 1))
    model.damping(local=0.8)
    model.gravity(0, -10)
    model.cycle(1500)
    model.gravity(1.44, -10)  # the resultant at the base comes to 0.36 from the middle of a brick
    model.cycle(10_000)
    return model


LEANING = 1000  # blocks in columns that lean


def pressed(blocks: int, kind: str, per_length: bool) -> Model:
    """A slab at rest, all of whose contacts are closed; its joints have a joint material, or none."""
    model = slab(blocks)
    if per_length:
        model.jproperty(1, kn=1e11, ks=1e11, friction=0.5, between=(1, 1))
    model.cycle(1)
    squeeze(model)
    model.damping(local=0.8)
    if kind != "rigid":
        model.property(1, bulk=1e10, g=6e9)
        model.change(-FAR, FAR, -FAR, FAR, type=kind)
    if kind == "fdef":
        warnings.simplefilter("ignore")  # blocks are not quite at rest yet
        model.generate(-FAR, FAR, -FAR, FAR, edge=0.5)
    model.cycle(1000)
    return model


def bench_joints(sizes: list[int]) -> None:
    """Cycles with joint materials against those of 1980 with as many closed contacts; open ones cost less."""
    print("| blocks | type | closed | 1980, ms | joint material, ms | ratio |\n|---|---|---|---|---|---|")
    for blocks in sizes:
        for kind in ("rigid", "sdef", "fdef"):
            models = [pressed(blocks, kind, per_length) for per_length in (False, True)]
            if kind == "fdef":
                compare_joints(blocks, "fdef, zones made late", models)
                for model in models:
                    put_in_order(model)
            compare_joints(blocks, kind, models)
    compare_joints(LEANING, "leaning", [leaning(LEANING, per_length) for per_length in (False, True)])


def put_in_order(model: Model) -> None:
    """Put groups in the order that they get by the first CYCLE if their zones are made before it."""
    ci = model.h.ci
    cycles, ci[g.MCTOT] = int(ci[g.MCTOT]), 0
    arrange(model.array)
    ci[g.MCTOT] = cycles


def compare_joints(blocks: int, kind: str, models: list[Model], cycles: int = 100) -> None:
    """A row of the table: the times of a cycle of two models, and their ratio."""
    times = []
    for _ in range(max(TURNS, 75_000 // blocks)):  # short turns vary more
        clock = [process_time()]
        for model in models:
            model.cycle(cycles)
            clock.append(process_time())
        times.append(np.diff(clock) / cycles * 1e3)
    old, new = np.median(times, axis=0)
    ratio = np.median([after / before for before, after in times])
    closed = ", ".join(str(np.count_nonzero(table(model.array, "contact")["KCFN"])) for model in models)
    print(f"| {blocks} | {kind} | {closed} | {old:.3f} | {new:.3f} | {ratio:.2f} |", flush=True)


def bench_water(sizes: list[int]) -> None:
    """Steps of flow against a structure of arrays, and cycles with water against those without."""
    print("| blocks | steps of flow, ms | in arrays, ms | ratio | dry cycle, ms | wet cycle, ms |")
    print("|---|---|---|---|---|---|")
    for blocks in sizes:
        dry, wet = jointed(blocks, True), jointed(blocks, True)
        wet_slab(wet)
        ours, arrays = (1e3 * seconds for seconds in compare_flow(wet))
        cycles = []
        for model in (dry, wet):
            model.cycle(10)
            start = process_time()
            model.cycle(100)
            cycles.append((process_time() - start) * 10)
        flows = f"{ours:.3f} | {arrays:.3f} | {ours / arrays:.2f}"
        print(f"| {blocks} | {flows} | {cycles[0]:.3f} | {cycles[1]:.3f} |", flush=True)


def bench_ball() -> None:
    """The ball from the command line: first run with nothing compiled, alone and with a second compiler."""
    print("| ball-rolling.dat | s of wall time | s of processor time |\n|---|---|---|")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        command = [sys.executable, "-m", "udec_ia", "run", "examples/ball-rolling.dat", "--out", folder]
        for name, cache, ahead in (
            ("first run, one process", "one", "0"),
            ("first run", "two", "1"),
            ("second run", "one", "0"),
            ("third run", "one", "0"),
        ):
            env = {**os.environ, "UDEC_CACHE": str(Path(folder) / cache), "UDEC_AHEAD": ahead}
            start, before = perf_counter(), os.times()
            subprocess.run(command, cwd=ROOT, env=env, check=True, capture_output=True)
            wall, after = perf_counter() - start, os.times()
            cpu = after.children_user + after.children_system - before.children_user - before.children_system
            print(f"| {name} | {wall:.1f} | {cpu:.1f} |", flush=True)


def main() -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description="Measure the speed of cycles, of SPLIT and of the ball.")
    parser.add_argument("what", nargs="*", help="cycle zones split proof change laws joints water ball")
    parser.add_argument("--blocks", type=int, nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--zones", type=int, nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--cut", type=int, nargs="+", default=[30_000, 300_000])
    parser.add_argument("--skew", type=float, default=0.0, help="lean of the second joint set, dx to dy")
    parser.add_argument("--cycles", type=int, default=0, help="of one turn (default: of 2 million contacts)")
    args = parser.parse_args()
    benches: dict[str, Callable[[], None]] = {
        "cycle": lambda: bench_cycles(args.blocks, args.skew, args.cycles),
        "zones": lambda: bench_zones(args.zones),
        "split": lambda: bench_split(args.cut),
        "proof": lambda: bench_proof(args.blocks),
        "change": lambda: bench_change(args.blocks),
        "laws": bench_laws,
        "joints": lambda: bench_joints(args.blocks),
        "water": lambda: bench_water(args.blocks),
        "ball": bench_ball,
    }
    for name in args.what or benches:
        benches.get(name, parser.print_help)()
