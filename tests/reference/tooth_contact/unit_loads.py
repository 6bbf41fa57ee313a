"""Unit loads on one tooth in CalculiX, without contact: what influence numbers are compared with.

Section: ``ToothForm`` on a full ring with three teeth, bore held. Plane strain (CPE6) or of finite face width with free
ends (C3D15). Deflection is that along the inward flank normal at the tooth-axis depth (``ToothForm.axis_depth``), so
that the local flattening is not in it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from dynamics.gear.tooth_form import ToothForm
from tests.builders.calculix import measure
from tests.reference.tooth_contact.deck import STEEL, nodal_blocks
from tests.reference.tooth_contact.section import MM, EdgeSizes, PlaneMesh, gear_section

Array = NDArray[np.float64]
OFFSETS = (-1, 0, 1)
COARSE = EdgeSizes(flank=0.1, fillet=0.06, corner=0.1, coarse=0.2, bore=0.12)


@dataclass(frozen=True, kw_only=True)
class UnitLoads:
    """What ccx gives per newton; n loads, f face positions (1 in plane strain).

    roll : (n,) roll length of the loaded points [m]; face : (f,) face positions from mid-face [m]
    deflection : (n, f, 3, n, f) of the teeth -1, 0, 1 at a point (last two) of a load (first two) [m/N];
        in plane strain per newton per metre of width [m2/N]
    fillet : (p, 2) points of the fillet, tooth on the y axis [m]; root_stress : (n, f, 3, p, f) tension along them
        [Pa/N], in plane strain [Pa m/N]
    """

    roll: Array
    face: Array
    deflection: Array
    fillet: Array
    root_stress: Array
    nodes: int


@dataclass(frozen=True, kw_only=True)
class FaceGrid:
    """Face width [m], positions of the hats [m] and layers of wedges over the width."""

    width: float
    positions: tuple[float, ...]
    layers: int = 12

    @property
    def planes(self) -> Array:
        """Between the layers, from mid-face [mm]."""
        return np.linspace(-0.5, 0.5, self.layers + 1) * self.width * MM

    def hat(self, index: int, z: Array) -> Array:
        """Hat of a position over z [mm], of integral 1 [1/mm]; those at the ends reach to the end of the face."""
        at = np.array(self.positions) * MM
        values = np.interp(z, at, np.eye(len(at))[index])
        fine = np.linspace(self.planes[0], self.planes[-1], 20001)
        return values / np.trapezoid(np.interp(fine, at, np.eye(len(at))[index]), fine)


@dataclass(frozen=True, kw_only=True)
class _Section:
    """Mesh of the section and what is looked at: loaded nodes, their roll lengths [m]."""

    form: ToothForm
    mesh: PlaneMesh
    nodes: NDArray[np.int64]
    rolls: Array


def unit_loads(
    form: ToothForm,
    bore_radius: float,
    rolls: Sequence[float],
    folder: Path,
    *,
    sizes: EdgeSizes = COARSE,
    face: FaceGrid | None = None,
) -> UnitLoads:
    """Load tooth 0 at roll lengths [m]; plane strain unless a face is given.

    bore_radius [m]. Runs ccx once, a step for every load.
    """
    folder.mkdir(parents=True, exist_ok=True)
    section = _section(form, bore_radius, rolls, sizes)
    lines = _plane_lines(section) if face is None else _solid_lines(section, face)
    (folder / "job.inp").write_text("".join(f"{line}\n" for line in lines))
    measure(["ccx", "-i", "job"], folder, {"OMP_NUM_THREADS": "1"})
    n_plane = len(section.mesh.points)
    planes = 1 if face is None else face.layers + 1
    moved = nodal_blocks(folder / "job.frd", "DISP", 3, n_plane * planes)
    return _unit_loads(section, face, np.array(moved).reshape(len(moved), planes, n_plane, 3))


def _section(form: ToothForm, bore_radius: float, rolls: Sequence[float], sizes: EdgeSizes) -> _Section:
    mesh = gear_section(form, bore_radius, teeth=3, sizes=sizes, flank_nodes=rolls)
    flank = mesh.lines["flank_0"][::2]
    radii = np.hypot(*mesh.points[flank].T) / MM
    chosen = [int(np.argmin(np.abs(radii - np.hypot(form.gear.base_radius, roll)))) for roll in rolls]
    return _Section(form=form, mesh=mesh, nodes=flank[chosen], rolls=np.array(rolls))


def _turned(vectors: Array, angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return vectors @ np.array([[c, s], [-s, c]])


def _normal(section: _Section, roll: float, tooth: int) -> Array:
    """Unit normal out of a tooth of the mesh at a roll length."""
    angle = 2.0 * np.pi * tooth / section.form.gear.teeth - 0.5 * np.pi
    return _turned(section.form.flank_normal(roll), angle)


def _axis_point(section: _Section, roll: float, tooth: int) -> Array:
    form = section.form
    point = form.axis_point(roll)
    return _turned(point * MM, 2.0 * np.pi * tooth / form.gear.teeth - 0.5 * np.pi)


def _plane_lines(section: _Section) -> Iterator[str]:
    mesh = section.mesh
    yield "*NODE, NSET=NALL"
    yield from (f"{k}, {x:.14g}, {y:.14g}, 0." for k, (x, y) in enumerate(mesh.points, start=1))
    yield "*ELEMENT, TYPE=CPE6, ELSET=ALL"
    yield from (f"{k}, " + ", ".join(map(str, cell)) for k, cell in enumerate(mesh.cells + 1, start=1))
    yield from _material("1.")
    yield "*BOUNDARY"
    yield from (f"{node + 1}, 1, 2" for node in np.unique(mesh.lines["bore"]))
    for node, roll in zip(section.nodes, section.rolls, strict=True):
        push = -_normal(section, roll, 0)
        yield "*STEP\n*STATIC\n*CLOAD, OP=NEW"
        yield f"{node + 1}, 1, {push[0]:.14g}\n{node + 1}, 2, {push[1]:.14g}"
        yield "*NODE FILE, OUTPUT=2D\nU\n*END STEP"


def _material(section: str) -> Iterator[str]:
    yield f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{STEEL[0]}, {STEEL[1]}"
    yield f"*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n{section}"


def _solid_lines(section: _Section, face: FaceGrid) -> Iterator[str]:
    """Wedges between the planes; nodes plane by plane, then those halfway between the corners."""
    mesh, planes = section.mesh, face.planes
    n, corners = len(mesh.points), int(mesh.cells[:, :3].max()) + 1
    yield "*NODE, NSET=NALL"
    for k, z in enumerate(planes):
        yield from (
            f"{k * n + i}, {x:.14g}, {y:.14g}, {z:.14g}" for i, (x, y) in enumerate(mesh.points, start=1)
        )
    first = n * len(planes)
    for k, z in enumerate(0.5 * (planes[1:] + planes[:-1])):
        for i, (x, y) in enumerate(mesh.points[:corners], start=1):
            yield f"{first + k * corners + i}, {x:.14g}, {y:.14g}, {z:.14g}"
    yield "*ELEMENT, TYPE=C3D15, ELSET=ALL"
    number = 0
    for k in range(face.layers):
        low, high, between = k * n + 1, (k + 1) * n + 1, first + k * corners + 1
        for cell in mesh.cells:
            number += 1
            nodes = [
                *(cell[:3] + low), *(cell[:3] + high), *(cell[3:] + low), *(cell[3:] + high), *(cell[:3] + between)
            ]  # fmt: skip
            words = [str(number), *map(str, nodes)]
            yield ", ".join(words[:11]) + ",\n" + ", ".join(words[11:])
    yield from _material("")
    yield "*NSET, NSET=PLANES, GENERATE"
    yield f"1, {first}"
    yield "*BOUNDARY"
    bore = np.unique(mesh.lines["bore"])
    held = [bore + k * n for k in range(len(planes))]
    held += [bore[bore < corners] + first + k * corners for k in range(face.layers)]
    yield from (f"{node + 1}, 1, 3" for node in np.concatenate(held))
    for node, roll in zip(section.nodes, section.rolls, strict=True):
        push = -_normal(section, roll, 0)
        for index in range(len(face.positions)):
            yield "*STEP\n*STATIC\n*CLOAD, OP=NEW"
            for k, value in _along_width(face, index):
                number = node + 1 + (k // 2) * n if k % 2 == 0 else first + node + 1 + (k // 2) * corners
                yield f"{number}, 1, {push[0] * value:.14g}\n{number}, 2, {push[1] * value:.14g}"
            yield "*NODE FILE, NSET=PLANES\nU\n*END STEP"


def _along_width(face: FaceGrid, index: int) -> Iterator[tuple[int, float]]:
    """Share of the hat at the nodes over the width, every other one halfway between two planes."""
    shares = np.zeros(2 * face.layers + 1)
    at, weight = np.polynomial.legendre.leggauss(30)
    shape = np.array([0.5 * at * (at - 1.0), 1.0 - at**2, 0.5 * at * (at + 1.0)])
    for k, (low, high) in enumerate(zip(face.planes[:-1], face.planes[1:], strict=True)):
        z = 0.5 * (low + high) + 0.5 * (high - low) * at
        shares[2 * k : 2 * k + 3] += shape @ (weight * face.hat(index, z)) * 0.5 * (high - low)
    shares /= shares.sum()
    yield from ((k, float(value)) for k, value in enumerate(shares) if value)


def _unit_loads(section: _Section, face: FaceGrid | None, moved: Array) -> UnitLoads:
    """moved : (loads, planes, nodes, 3) displacement [mm]."""
    n = len(section.rolls)
    f = 1 if face is None else len(face.positions)
    deflection = np.zeros((n * f, 3, n, f))
    line = section.mesh.lines["fillet_0"]
    stress = np.zeros((n * f, 3, len(line) // 2, f))
    for k, tooth in enumerate(OFFSETS):
        for i, roll in enumerate(section.rolls):
            cell, shape = _found(section.mesh, _axis_point(section, roll, tooth))
            along = np.einsum("lpnd,n,d->lp", moved[:, :, cell, :2], shape, -_normal(section, roll, tooth))
            deflection[:, k, i] = _averaged(face, along)
        stress[:, k] = np.moveaxis(_root(section.mesh, face, moved, tooth), 2, 1)
    # per newton on a millimetre in plane strain; per newton on the face else
    scale = 1.0 / MM if face is not None else 1.0 / MM**2
    per_stress = 1e6 if face is not None else 1e6 / MM
    fillet = _turned(section.mesh.points[line[1::2]], 0.5 * np.pi) / MM
    return UnitLoads(
        roll=section.rolls,
        face=np.zeros(1) if face is None else np.array(face.positions),
        deflection=deflection.reshape(n, f, 3, n, f) * scale,
        fillet=fillet,
        root_stress=stress.reshape(n, f, 3, -1, f) * per_stress,
        nodes=moved.shape[1] * moved.shape[2],
    )


def _averaged(face: FaceGrid | None, along: Array) -> Array:
    """(loads, f) from (loads, planes): mean under the hats."""
    if face is None:
        return along
    z = np.linspace(face.planes[0], face.planes[-1], 4001)
    smooth = CubicSpline(face.planes, along, axis=1)(z)
    return np.stack(
        [np.trapezoid(smooth * face.hat(k, z), z, axis=1) for k in range(len(face.positions))], axis=1
    )


def _root(mesh: PlaneMesh, face: FaceGrid | None, moved: Array, tooth: int) -> Array:
    """(loads, f, p) tension along the fillet from the strains on the free surface [N/mm2]; at the face positions."""
    line = mesh.lines[f"fillet_{tooth}"]
    edge = mesh.points[line[2::2]] - mesh.points[line[:-2:2]]
    stretch = moved[:, :, line[2::2], :2] - moved[:, :, line[:-2:2], :2]
    along = (stretch * edge).sum(axis=-1) / (edge**2).sum(axis=-1)
    modulus = STEEL[0] / (1.0 - STEEL[1] ** 2)
    if face is None:
        return modulus * along
    at = np.array(face.positions) * MM
    axial = CubicSpline(face.planes, moved[:, :, line[1::2], 2], axis=1)(at, 1)
    return np.asarray(modulus * (CubicSpline(face.planes, along, axis=1)(at) + STEEL[1] * axial))


def _found(mesh: PlaneMesh, point: Array) -> tuple[Array, Array]:
    """Nodes of the cell around a point and their shape functions there."""
    a, b, c = (mesh.points[mesh.cells[:, k]] for k in range(3))
    area = _cross(b - a, c - a)
    share = (
        np.stack([_cross(b - point, c - point), _cross(c - point, a - point), _cross(a - point, b - point)])
        / area
    )
    best = int(np.argmax(share.min(axis=0)))
    assert share[:, best].min() > -1e-9, f"point {point} lies outside of the mesh"
    x, y, z = share[:, best]
    shape = np.array([x * (2 * x - 1), y * (2 * y - 1), z * (2 * z - 1), 4 * x * y, 4 * y * z, 4 * z * x])
    return mesh.cells[best], shape


def _cross(u: Array, v: Array) -> Array:
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
