"""The power circuit as the truth sees it: torsion of stepped shafts, and every gear free to move sideways.

Torsional bars with consistent mass, gears on their splines, couplings, motor. Each gear has two more freedoms along
the line of action: itself on the bending shaft, and the journals in their oil films. Angles count in the running
direction of their own shaft. Meshes stay outside (`loop_march`).
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.linalg import eigh

from tests.virtual_rig.losses_sump import roller_stiffness
from tests.virtual_rig.teeth import Teeth

SHEAR, YOUNG, DENSITY = 79.0e9, 206.0e9, 7850.0
ELEMENT = 0.09
"""Longest torsional element [m]."""
ROLLER_DAMPING = 1.25e-5
"""Damping over stiffness of a rolling bearing [s]."""
RIGID_SEAT = 5e7
"""Gear without a spline [N m/rad]."""


@dataclass
class Matrices:
    """Freedoms by name, and M, C, K of the circuit without its meshes."""

    names: list[str] = field(default_factory=list)
    mass: list[tuple[int, int, float]] = field(default_factory=list)
    springs: list[tuple[int, int, float]] = field(default_factory=list)
    dashpots: list[tuple[int, int, float]] = field(default_factory=list)

    def add(self, name: str, inertia: float = 0.0) -> int:
        self.names.append(name)
        at = len(self.names) - 1
        if inertia:
            self.mass.append((at, at, inertia))
        return at

    def join(self, a: int, b: int, stiffness: float, damping: float = 0.0) -> None:
        """Spring and dashpot between two freedoms; b = -1 is the ground."""
        self.springs.append((a, b, stiffness))
        self.dashpots.append((a, b, damping))

    def assembled(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        n = len(self.names)
        mass = np.zeros((n, n))
        for a, b, value in self.mass:
            mass[a, b] += value
        found = []
        for parts in (self.dashpots, self.springs):
            matrix = np.zeros((n, n))
            for a, b, value in parts:
                matrix[a, a] += value
                if b >= 0:
                    matrix[b, b] += value
                    matrix[a, b] -= value
                    matrix[b, a] -= value
            found.append(matrix)
        return mass, found[0], found[1]


@dataclass(frozen=True, kw_only=True)
class Joint:
    """Coupling between freedoms a and b."""

    a: int
    b: int
    stiffness: float
    damping: float


@dataclass(frozen=True, kw_only=True)
class Circuit:
    """Linear part of the loop at one operating point."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    names: tuple[str, ...]
    gears: Mapping[str, int]
    lateral: Mapping[str, int]
    ends: Mapping[tuple[str, str], int]
    seats: Mapping[str, int]
    couplings: Mapping[str, Joint]
    motor: int
    lines: np.ndarray
    """Shaft line of every torsional freedom, -1 of a lateral one."""
    approach: np.ndarray
    """(n_meshes, n): approach of the working flanks per freedom [m]."""
    directions: tuple[int, ...]
    """+1 where the pinion drives (front flanks), -1 where the wheel does."""
    modes: np.ndarray
    """(n, n) mass-normalised, the two rigid ones first."""
    frequencies: np.ndarray
    """[rad/s]"""

    @property
    def size(self) -> int:
        return len(self.names)

    def receptance(self, frequency: float, load: np.ndarray) -> np.ndarray:
        """Answer (n, ...) to harmonic loads (n, ...) at ``frequency`` [rad/s]."""
        matrix = self.stiffness - frequency**2 * self.mass + 1j * frequency * self.damping
        return np.linalg.solve(matrix, load)


def read_circuit(
    tree: Mapping[str, Any],
    meshes: Sequence[Teeth],
    speed: float,
    torque: float,
    scale: Mapping[str, float],
    *,
    at_rest: bool = False,
) -> Circuit:
    """Circuit of a case at a pinion speed [rad/s] and torque [N m].

    scale : factors by name: shaft_stiffness:<shaft>, coupling_stiffness:<c>, coupling_damping:<c>,
        spline_stiffness:<gear>, spline_damping:<gear>, inertia:<gear>, inertia:motor, journal_stiffness,
        journal_damping, shaft_bending, shaft_damping, flange_inertia; 1 where missing
    at_rest : journals lie on metal, no film
    """
    power = tree["drivetrain"]
    parts = Matrices()
    ends: dict[tuple[str, str], int] = {}
    nodes: dict[str, list[tuple[float, int]]] = {}
    shaft_of: list[str] = []
    positions = _stations(tree)
    for name, shaft in power["shafts"].items():
        nodes[name] = _bar(parts, name, shaft, positions[name], scale.get(f"shaft_stiffness:{name}", 1.0))
        shaft_of += [name] * len(nodes[name])
        ends[name, "start"], ends[name, "end"] = nodes[name][0][1], nodes[name][-1][1]
        for disc in shaft.get("discs", {}).values():
            at = _nearest(nodes[name], disc["position"])
            parts.mass.append((at, at, disc["inertia"] * scale.get("flange_inertia", 1.0)))
    gears, seats = {}, {}
    for mesh in meshes:
        for index, gear in enumerate(mesh.gears):
            if gear in gears:
                continue
            entry = _gear(tree, gear)
            spline = entry.get("spline", {})
            inertia = entry.get("inertia", mesh.inertias[index]) * scale.get(f"inertia:{gear}", 1.0)
            seats[gear] = _nearest(nodes[entry["shaft"]], entry["position"])
            gears[gear] = parts.add(gear, inertia)
            shaft_of.append(entry["shaft"])
            parts.join(
                gears[gear],
                seats[gear],
                spline.get("torsional_stiffness", RIGID_SEAT) * scale.get(f"spline_stiffness:{gear}", 1.0),
                spline.get("torsional_damping", 0.0) * scale.get(f"spline_damping:{gear}", 1.0),
            )
    couplings = {}
    for name, entry in power["couplings"].items():
        a, b = (ends[shaft, end] for shaft, end in zip(entry["shafts"], entry["ends"]))
        stiffness = entry["torsional_stiffness"] * scale.get(f"coupling_stiffness:{name}", 1.0)
        damping = entry["torsional_damping"] * scale.get(f"coupling_damping:{name}", 1.0)
        parts.join(a, b, stiffness, damping)
        couplings[name] = Joint(a=a, b=b, stiffness=stiffness, damping=damping)
        if f"absorber:{name}" in scale:
            _absorber(parts, shaft_of, a, entry["shafts"][0], scale[f"absorber:{name}"])
    motor = ends[power["motor"]["shaft"], power["motor"]["end"]]
    parts.mass.append((motor, motor, power["motor"]["inertia"] * scale.get("inertia:motor", 1.0)))
    n_torsion = len(parts.names)
    lateral = {}
    for mesh in meshes:
        for index, gear in enumerate(mesh.gears):
            force = torque / mesh.base_radii[0]
            lateral[gear] = _sideways(parts, tree, gear, mesh.masses[index], force, speed, scale, at_rest)
    mass, damping, stiffness = parts.assembled()
    lines = np.full(len(parts.names), -1)
    lines[:n_torsion] = _lines(power, shaft_of)
    directions = _directions(tree, meshes, gears, lines)
    approach = np.zeros((len(meshes), len(parts.names)))
    for row, (mesh, sign) in enumerate(zip(meshes, directions)):
        for gear, radius, way in zip(mesh.gears, mesh.base_radii, (1.0, -1.0)):
            approach[row, gears[gear]] = sign * way * radius
            approach[row, lateral[gear]] = -1.0
    squares, modes = eigh(stiffness, mass)
    frequencies = np.sqrt(np.maximum(squares, 0.0))
    frequencies[:2] = 0.0
    solid = 2.0 * 0.004 * scale.get("shaft_damping", 1.0) * frequencies
    solid[frequencies > 2e5] = 0.0
    damping = damping + mass @ (modes * solid) @ modes.T @ mass
    return Circuit(
        mass=mass, damping=damping, stiffness=stiffness, names=tuple(parts.names), gears=gears, lateral=lateral,
        ends=ends, seats=seats, couplings=couplings, motor=motor, lines=lines, approach=approach,
        directions=directions, modes=modes, frequencies=frequencies,
    )  # fmt: skip


def standing_frequencies(circuit: Circuit, mesh_stiffness: Sequence[float]) -> np.ndarray:
    """Torsional natural frequencies with closed meshes at rest [Hz], the running mode left out."""
    stiffness = circuit.stiffness.copy()
    for row, value in zip(circuit.approach, mesh_stiffness):
        stiffness += value * np.outer(row, row)
    squares, modes = eigh(stiffness, circuit.mass)
    torsional = circuit.lines >= 0
    kinetic = np.einsum("ij,ij->j", modes[torsional], (circuit.mass @ modes)[torsional])
    keep = (kinetic > 0.5) & (squares > (2.0 * math.pi) ** 2)
    return np.sqrt(squares[keep]) / (2.0 * math.pi)


def speed_ratio(tree: Mapping[str, Any], meshes: Sequence[Teeth], circuit: Circuit, line: int) -> float:
    """Speed of a shaft line over that of the gear at which the case counts."""
    at = circuit.lines[circuit.gears[tree["drivetrain"]["torque_at"]]]
    if line == at:
        return 1.0
    mesh = meshes[0]
    first = circuit.lines[circuit.gears[mesh.gears[0]]]
    return mesh.z[0] / mesh.z[1] if at == first else mesh.z[1] / mesh.z[0]


def _stations(tree: Mapping[str, Any]) -> dict[str, list[float]]:
    found: dict[str, list[float]] = {name: [] for name in tree["drivetrain"]["shafts"]}
    for box in tree["gearboxes"].values():
        for gear in box["gears"].values():
            found[gear["shaft"]].append(gear["position"])
    for name, shaft in tree["drivetrain"]["shafts"].items():
        found[name] += [disc["position"] for disc in shaft.get("discs", {}).values()]
    return found


def _bar(
    parts: Matrices, name: str, shaft: Mapping[str, Any], stations: Sequence[float], scale: float
) -> list[tuple[float, int]]:
    """Torsional bar elements of one shaft; its nodes as (position, freedom)."""
    edges = np.concatenate(([0.0], np.cumsum([section["length"] for section in shaft["sections"]])))
    marks = sorted({*np.round(edges, 7), *(round(float(np.clip(s, 0.0, edges[-1])), 7) for s in stations)})
    places = [marks[0]]
    for left, right in itertools.pairwise(marks):
        pieces = max(1, math.ceil((right - left) / ELEMENT))
        places += [left + (right - left) * (i + 1) / pieces for i in range(pieces)]
    nodes = [(float(place), parts.add(f"{name}@{place:.4f}")) for place in places]
    for (left, a), (right, b) in itertools.pairwise(nodes):
        section = shaft["sections"][
            min(int(np.searchsorted(edges, 0.5 * (left + right))) - 1, len(edges) - 2)
        ]
        outer, inner = section["outer_diameter"], section.get("inner_diameter", 0.0)
        polar = math.pi * (outer**4 - inner**4) / 32.0
        parts.join(a, b, scale * SHEAR * polar / (right - left))
        inertia = DENSITY * polar * (right - left)
        for i, j, share in ((a, a, 3.0), (b, b, 3.0), (a, b, 1.5), (b, a, 1.5)):
            parts.mass.append((i, j, inertia * share / 9.0))
    return nodes


def _absorber(parts: Matrices, shaft_of: list[str], at: int, shaft: str, inertia: float) -> None:
    """A loose ring on a flange that swings at 150 Hz: no part of any drawing."""
    ring = parts.add("loose ring", inertia)
    shaft_of.append(shaft)
    stiffness = inertia * (2.0 * math.pi * 150.0) ** 2
    parts.join(ring, at, stiffness, 0.1 * math.sqrt(stiffness * inertia))


def _nearest(nodes: Sequence[tuple[float, int]], position: float) -> int:
    return min(nodes, key=lambda node: abs(node[0] - position))[1]


def _gear(tree: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    box, gear = name.split(".")
    return tree["gearboxes"][box]["gears"][gear]


def _sideways(
    parts: Matrices,
    tree: Mapping[str, Any],
    gear: str,
    mass: float,
    force: float,
    speed: float,
    scale: Mapping[str, float],
    at_rest: bool,
) -> int:
    """Freedoms of gear and journals along the line of action: shaft bending in series with its two bearings."""
    box = tree["gearboxes"][gear.split(".")[0]]
    entry = _gear(tree, gear)
    bearings = [b for b in box["bearings"].values() if b["shaft"] == entry["shaft"]]
    places = sorted(b["position"] for b in bearings)
    span = places[-1] - places[0]
    left = min(max(entry["position"] - places[0], 0.05 * span), 0.95 * span)
    seat = max(entry.get("bore_diameter", 0.0), bearings[0]["diameter"])
    bending = 3.0 * YOUNG * math.pi * seat**4 / 64.0 * span / (left * (span - left)) ** 2
    bending *= scale.get("shaft_bending", 1.0)
    film, damping = (_rollers if "rollers" in bearings[0] else _films)(bearings, force, speed, scale)
    if at_rest:
        film, damping = film if "rollers" in bearings[0] else 2e9, 0.0
    shaft_mass = DENSITY * 0.25 * math.pi * seat**2 * span
    wheel = parts.add(f"{gear}/sideways", mass + 0.5 * shaft_mass)
    journal = parts.add(f"{gear}/journal", 0.5 * shaft_mass)
    parts.join(wheel, journal, bending)
    parts.join(journal, -1, film, damping)
    return wheel


def _films(
    bearings: Sequence[Mapping[str, Any]], force: float, speed: float, scale: Mapping[str, float]
) -> tuple[float, float]:
    """Oil films: stiffness grows with the load over the clearance, damping with stiffness over speed."""
    gap = 0.5 * bearings[0]["diametral_clearance"]
    film = (
        len(bearings) * (3e7 + 3.0 * abs(force) / len(bearings) / gap) * scale.get("journal_stiffness", 1.0)
    )
    return film, 0.5 * film / max(speed, 50.0) * scale.get("journal_damping", 1.0)


def _rollers(
    bearings: Sequence[Mapping[str, Any]], force: float, speed: float, scale: Mapping[str, float]
) -> tuple[float, float]:
    """Rollers: line contacts, damping in proportion (Kraemer: 0.25e-5 to 2.5e-5 s times the stiffness)."""
    one = bearings[0]
    each = roller_stiffness(abs(force) / len(bearings), one["rollers"], one["roller_length"])
    stiffness = len(bearings) * each * scale.get("journal_stiffness", 1.0)
    return stiffness, ROLLER_DAMPING * stiffness * scale.get("journal_damping", 1.0)


def _lines(power: Mapping[str, Any], shaft_of: Sequence[str]) -> np.ndarray:
    line = {shaft: i for i, shaft in enumerate(power["shafts"])}
    for entry in power["couplings"].values():
        keep, drop = sorted(line[shaft] for shaft in entry["shafts"])
        line = {shaft: keep if value == drop else value for shaft, value in line.items()}
    return np.array([line[shaft] for shaft in shaft_of])


def _directions(
    tree: Mapping[str, Any], meshes: Sequence[Teeth], gears: Mapping[str, int], lines: np.ndarray
) -> tuple[int, ...]:
    """The counted gear drives its mesh by the front flank; across the loop the power goes back."""
    own = tree["drivetrain"]["torque_at"].split(".")[0]
    return tuple(1 if mesh.name.split(".")[0] == own else -1 for mesh in meshes)
