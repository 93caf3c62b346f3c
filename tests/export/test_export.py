"""Exported files are read by other programs, and their numbers are those of the words."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
import pyvista
import shapely
import vtk

from udec_ia import Model, UdecError
from udec_ia.cli import main
from udec_ia.export import export
from udec_ia.export.export_files import FORMATS
from udec_ia.heap.accessors import puti, putr
from udec_ia.layout import offsets as g
from udec_ia.reader.joint_rows import STATES

PARTS = ["blocks", "zones", "contacts", "water", "structures"]


def scene(build: str = "i32r64") -> Model:
    """A rigid block, a simply-deformable one and one with zones on a base; a bolt, and water between them."""
    m = Model(build)
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    m.block(0, 0, 0, 1, 5, 1, 5, 0)
    for x in (0.25, 1.5, 3.0):
        m.block(x, 1, x, 2, x + 1, 2, x + 1, 1)
    m.round(0.05)
    m.change(1.5, 2.5, 1, 2, type="sdef")
    m.generate(3, 4, 1, 2, edge=0.5)
    m.fix(0, 5, 0, 1)
    m.gravity(0, -10)
    m.jproperty(1, kn=1e9, ks=1e9, friction=0.5, aperture=1e-3, between=(1, 1))
    m.sproperty(1, kn=1e6, yield_force=1e5)
    m.bolt(0.75, 1.5, 0.75, 0.5, smaterial=1)
    m.fluid(kw=1e6)
    return m


def read(path: Path, step: int) -> Any:
    """The parts of a state in a file, by name, as pyvista has them."""
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    reader.SetStep(step)
    reader.Update()
    return pyvista.wrap(reader.GetOutputDataObject(0))


def outlines(part: Any) -> list[Any]:
    """The polygons of a part."""
    return [shapely.Polygon(part.get_cell(k).points[:, :2]) for k in range(part.n_cells)]


@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_a_series_has_the_words_of_each_state(tmp_path: Path, build: str) -> None:
    m, states, files = scene(build), [], []
    for k in range(3):
        if build == "i32r64":  # to compile the other takes long, and a state before the first cycle will do
            m.cycle(10)
        if k == 1:
            m.block(0.25, 3, 0.25, 4, 1.25, 4, 1.25, 3)
        states.append({kind: m.table(kind) for kind in ("block", "corner", "contact", "zone", "gridpoint")})
        files.append(str(tmp_path / f"{k}.h5"))
        m.save(files[-1])
    out = tmp_path / "series.vtkhdf"
    assert main(["export", *files, str(out)]) == 0
    assert pyvista.get_reader(out).read().keys() == PARTS
    for step, tables in enumerate(states):
        parts = read(out, step)
        kinds = {"blocks": "block", "zones": "zone", "contacts": "contact"}
        tables["contact"] = tables["contact"][tables["contact"]["KCCOD"] != g.VIRTUAL]
        for name, kind in kinds.items():
            for column in tables[kind].dtype.names:
                found = np.asarray(parts[name].cell_data[column])
                assert np.array_equal(found, tables[kind][column]), (name, column)
                assert found.dtype == tables[kind][column].dtype
        for column in tables["gridpoint"].dtype.names:
            assert np.array_equal(parts["zones"].point_data[column], tables["gridpoint"][column])
        corners, centres = tables["corner"], tables["block"]
        assert np.array_equal(parts["blocks"].points[:, 0], corners["KXP"])
        for polygon, row in zip(outlines(parts["blocks"]), centres, strict=True):
            assert polygon.contains(shapely.Point(row["KX"], row["KY"]))
        stress = np.array([[z["KZS11"], z["KZS12"], z["KZS22"]] for z in tables["zone"]])
        assert np.array_equal(parts["zones"].cell_data["stress"], stress)
        assert len(parts["structures"].cell_data["force"]) == 1
        assert parts["water"].n_points > 0
    areas = [polygon.area for polygon in outlines(parts["zones"])]
    assert sum(areas) == pytest.approx(1.0, rel=1e-3)


def test_zones_and_displacements_may_begin_in_a_later_state(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e8, g=6e7)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.save(tmp_path / "0.h5")
    m.displacements()
    m.generate("ALL", edge=1)
    m.gravity(3, -10)
    m.cycle(20)
    m.save(tmp_path / "1.h5")
    out = tmp_path / "series.vtkhdf"
    assert main(["export", str(tmp_path / "0.h5"), str(tmp_path / "1.h5"), str(out)]) == 0
    with h5py.File(out) as file:
        for part in ("blocks", "zones"):
            steps = file["VTKHDF"][part]["Steps"]
            for kind in ("CellDataOffsets", "PointDataOffsets"):
                assert {len(one) for one in steps.get(kind, {}).values()} <= {int(steps.attrs["NSteps"])}
    rows = m.table("pointdisplacement")
    found = read(out, 1)["zones"].point_data["displacement"]
    assert np.array_equal(found[:, 0], rows["KGDX"])
    assert np.array_equal(found[:, 1], rows["KGDY"])


def test_stress_of_blocks_is_the_mean_of_their_zones(tmp_path: Path) -> None:
    m = scene()
    m.cycle(50)
    (path,) = m.export(tmp_path / "a.vtkhdf")
    parts = read(path, 0)
    stress = np.asarray(parts["blocks"].cell_data["stress"])
    rigid = np.isnan(stress).all(axis=1)
    assert rigid.sum() == 2
    assert not np.isnan(stress[~rigid]).any()
    zones = parts["zones"]
    areas = [polygon.area for polygon in outlines(zones)]
    mean = np.average(zones.cell_data["stress"], axis=0, weights=areas)
    assert np.abs(stress - mean).sum(axis=1)[~rigid].min() < 1e-3 * np.abs(mean).max()


def test_tables_and_geojson_have_the_same_numbers(tmp_path: Path) -> None:
    m = scene()
    m.cycle(20)
    files = m.export(tmp_path / "a.csv")
    tables = [*PARTS[:2], "gridpoints", *PARTS[2:]]
    assert [file.name for file in files] == [f"a-{name}.csv" for name in tables]
    with open(files[0], newline="") as text:
        rows = list(csv.DictReader(text))
    blocks = m.table("block")
    for name in ("KX", "KYD", "KBFY"):
        assert [float(row[name]) for row in rows] == blocks[name].tolist()
    (path,) = m.export(tmp_path / "a.geojson")
    features = json.loads(path.read_text())["features"]
    shapes = [f for f in features if f["properties"]["part"] == "blocks"]
    assert [f["properties"]["KX"] for f in shapes] == blocks["KX"].tolist()
    for feature in shapes:
        outline = shapely.geometry.shape(feature["geometry"])
        assert outline.is_valid
        assert outline.exterior.is_ccw
    assert {f["geometry"]["type"] for f in features} == {"Polygon", "Point", "LineString"}


def test_displacements_groups_and_joint_materials(tmp_path: Path) -> None:
    m = scene()
    first, second = tmp_path / "1.h5", tmp_path / "2.h5"
    m.cycle(5)
    m.save(first)
    m.displacements()
    m.group("load", 0, 2, 1, 2)
    m.cycle(20)
    m.save(second)
    out = tmp_path / "a.vtkhdf"
    assert main(["export", str(first), str(second), str(out)]) == 0
    before, after = read(out, 0), read(out, 1)
    assert np.isnan(before["blocks"].cell_data["displacement"]).all()
    assert not before["blocks"].cell_data["group LOAD"].any()
    moved, points = m.table("displacement"), m.table("pointdisplacement")
    assert np.array_equal(after["blocks"].cell_data["displacement"][:, 1], moved["KBDY"])
    assert np.array_equal(after["blocks"].cell_data["rotation"], moved["KBDT"])
    assert np.array_equal(after["zones"].point_data["displacement"][:, 0], points["KGDX"])
    x = m.table("block")["KX"]
    assert np.array_equal(after["blocks"].cell_data["group LOAD"], (x > 0) & (x < 2) & (moved["KBDY"] != 0))
    assert (after["contacts"].cell_data["jmaterial"] == 1).all()


def test_a_drawing_has_all_outlines(tmp_path: Path) -> None:
    m = scene()
    m.cycle(5)
    (path,) = m.export(tmp_path / "a.svg")
    root = ElementTree.parse(path).getroot()
    space = "{http://www.w3.org/2000/svg}"
    layers = {layer.get("id"): layer for layer in root.iter(f"{space}g") if layer.get("id")}
    assert list(layers) == PARTS
    corners = {block: [] for block in m.table("block")["address"].tolist()}
    for row in m.table("corner"):
        corners[int(row["KNB"])].append((row["KXP"], row["KYP"]))
    for shape, (block, places) in zip(layers["blocks"], corners.items(), strict=True):
        drawn = [pair.split(",") for pair in shape.get("d").strip("MZ").split("L")]
        assert np.asarray(drawn, float) == pytest.approx(np.array(places), rel=1e-9)
        assert shape[0].text.startswith(f"block@{block},")
    left, top, width, height = (float(n) for n in root.get("viewBox").split())
    assert left < 0 < 5 < left + width
    assert -top - height < 0 < 2 < -top


def test_other_endings_and_files_are_refused(tmp_path: Path) -> None:
    m = scene()
    with pytest.raises(UdecError) as error:
        m.export(tmp_path / "a.txt")
    assert error.value.number == 10
    deck = tmp_path / "a.vtkhdf"
    deck.write_text("START\n")
    with pytest.raises(UdecError) as error:
        export(deck, [m.array])
    assert error.value.number == 31
    assert deck.read_text() == "START\n"


FOREIGN = {
    "map.geojson": json.dumps({"type": "FeatureCollection", "features": []}),
    "icon.svg": '<svg xmlns="http://www.w3.org/2000/svg"></svg>',
    "run-blocks.csv": "time,address,name\n",
}


@pytest.mark.parametrize("name", FOREIGN)
def test_what_others_have_written_stays(name: str, tmp_path: Path) -> None:
    m, path = scene(), tmp_path / name
    path.write_text(FOREIGN[name])
    target = tmp_path / name.replace("-blocks", "")
    with pytest.raises(UdecError) as error:
        m.export(target)
    assert error.value.number == 31
    assert path.read_text() == FOREIGN[name]
    path.unlink()
    for _ in range(2):  # what it has written itself is replaced
        assert path in m.export(target)


def test_a_series_of_others_stays(tmp_path: Path) -> None:
    path = tmp_path / "a.vtkhdf"
    with h5py.File(path, "w") as file:
        file.create_group("VTKHDF").attrs["Version"] = (2, 3)
    before = path.read_bytes()
    with pytest.raises(UdecError) as error:
        scene().export(path)
    assert error.value.number == 31
    assert path.read_bytes() == before


def test_tables_of_empty_parts_take_the_place_of_former_ones(tmp_path: Path) -> None:
    m, path = scene(), tmp_path / "run.csv"
    assert {file.stem.partition("-")[2] for file in m.export(path)} == {*PARTS, "gridpoints"}
    points = m.table("gridpoint")
    with (tmp_path / "run-gridpoints.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["KXG"]) for row in rows] == points["KXG"].tolist()
    other = Model()
    other.block(0, 0, 0, 1, 1, 1, 1, 0)
    other.export(path)
    with (tmp_path / "run-structures.csv").open() as file:
        assert file.readline().startswith("time,address,")
        assert file.readline() == ""
    assert [file.name for file in other.export(tmp_path / "new.csv")] == ["new-blocks.csv"]


def test_states_that_cannot_be_exported_are_refused(tmp_path: Path) -> None:
    m = scene()
    m.cycle(5)
    early = m.array.copy()
    m.cycle(5)
    damaged = m.array.copy()
    zone = int(m.table("zone")["address"][0])
    puti(damaged.h, zone, g.KZG, 2**31 - 1)
    for name, states, number in (
        ("a.vtkhdf", [m.array, early], 10),
        *((f"a{ending}", [damaged], 20) for ending in FORMATS),
        *((f"a{ending}", [], 26) for ending in FORMATS),
    ):
        with pytest.raises(UdecError) as error:
            export(tmp_path / name, states)
        assert error.value.number == number
    assert not [*tmp_path.iterdir()]


def test_the_manual_has_the_numbers_of_the_states() -> None:
    page = (Path(__file__).parents[2] / "docs" / "export.md").read_text()
    assert f"`state` ({', '.join(f'{k} {name}' for k, name in enumerate(STATES))})" in page


def test_geojson_has_no_infinity(tmp_path: Path) -> None:
    m = scene()
    putr(m.array.h, int(m.table("zone")["address"][0]), g.KZS11, np.inf)
    (path,) = m.export(tmp_path / "a.geojson")
    json.loads(path.read_text(), parse_constant=pytest.fail)
