"""Cells, links and streams, and the sparse system they make: conduction, films, mixing oil, heat stored.

Every exchange enters two rows with opposite sign, so a solved system balances to rounding whatever its
coefficients are; what is nonlinear is passed in as coefficients and repeated by the caller.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

OUTSIDE = -1
"""Second end of a link to a given temperature."""


@dataclass
class Network:
    """Grown cell by cell, then frozen by `finish`."""

    conductivity: list[float] = field(default_factory=list)
    """Of the cell's material at 100 degC [W/(m K)]; 0 for oil and air."""
    capacity: list[float] = field(default_factory=list)
    """[J/K]"""
    conduction: list[tuple[int, int, float, float]] = field(default_factory=list)
    """cell, cell, half distance over area of each [1/m]."""
    contacts: list[tuple[str, float]] = field(default_factory=list)
    """Of each conduction link: contact group ('' none) and area its resistance counts on [m2]."""
    films: list[tuple[int, int, float, float, str, float]] = field(default_factory=list)
    """solid cell, oil cell or OUTSIDE, area, half distance over area, group, height share (-1/2 to 1/2)."""

    def cell(self, conductivity: float = 0.0, capacity: float = 1.0) -> int:
        """New cell; its number."""
        self.conductivity.append(conductivity)
        self.capacity.append(capacity)
        return len(self.capacity) - 1

    def join(self, one: int, two: int, reach_one: float, reach_two: float, area: float, contact: str = "",
             on: float = 0.0) -> None:  # fmt: skip
        """Conduction over ``area`` between two cells whose centres lie ``reach`` [m] off the common face.

        contact : group of a joint in between, whose resistance counts on the area ``on`` (0: on ``area``)
        """
        self.conduction.append((one, two, reach_one / area, reach_two / area))
        self.contacts.append((contact, on or area))

    def wet(self, solid: int, fluid: int, area: float, reach: float, group: str, height: float = 0.0) -> None:
        """Film of a group between a solid cell, its centre ``reach`` below the surface, and a fluid."""
        if area > 0.0:
            self.films.append((solid, fluid, area, reach / area, group, height))

    def finish(self) -> None:
        """Arrays from the lists."""
        self.k_cell = np.array(self.conductivity)
        self.c_cell = np.array(self.capacity)
        links = np.array(self.conduction).reshape(-1, 4)
        self.ci, self.cj = links[:, 0].astype(int), links[:, 1].astype(int)
        self.ri, self.rj = links[:, 2], links[:, 3]
        self.contact_area = np.array([area for _, area in self.contacts])
        names = [name for name, _ in self.contacts]
        self.contact_of = {name: np.flatnonzero([n == name for n in names]) for name in set(names) - {""}}
        self.fi = np.array([film[0] for film in self.films], dtype=int)
        self.fj = np.array([film[1] for film in self.films], dtype=int)
        self.fa = np.array([film[2] for film in self.films])
        self.fr = np.array([film[3] for film in self.films])
        self.fh = np.array([film[5] for film in self.films])
        groups = [film[4] for film in self.films]
        self.group_of = {name: np.flatnonzero([g == name for g in groups]) for name in dict.fromkeys(groups)}

    @property
    def size(self) -> int:
        """Number of cells."""
        return len(self.capacity)


@dataclass(frozen=True, kw_only=True)
class Loads:
    """What one pass of a point puts on the network."""

    film: np.ndarray
    """Coefficient of every film [W/(m2 K)]."""
    outside: np.ndarray
    """Temperature at the far end of every film that ends OUTSIDE [K]."""
    offset: np.ndarray
    """Of every film: what the fluid at its place is warmer than its cell [K]."""
    contact: np.ndarray
    """Resistance of every conduction link besides its conduction [K/W]."""
    slope: float
    """Relative change of conductivity per kelvin [1/K]."""
    source: np.ndarray
    """[W] by cell."""
    streams: Iterable[tuple[int, int, float]]
    """from, to, heat capacity flow [W/K]; from OUTSIDE is an entry (its heat is in ``entry``)."""
    entry: np.ndarray
    """Heat capacity flow times temperature that enters each cell from outside [W]."""


@dataclass(frozen=True, kw_only=True)
class Solved:
    """Temperatures and the flows that belong to them."""

    temperature: np.ndarray
    surface: np.ndarray
    """At the solid side of every film [K]."""
    film_heat: np.ndarray
    """From solid to fluid [W]."""
    imbalance: float
    """Sources and entries less exits, films outside and storage, over sources and heat outside."""


def solve(network: Network, loads: Loads, guess: np.ndarray, previous: np.ndarray | None = None,
          step: float = np.inf) -> Solved:  # fmt: skip
    """One linear solve with coefficients at ``guess``; with ``step`` [s] an implicit step from ``previous``."""
    n = network.size
    k = network.k_cell * (1.0 + loads.slope * (guess - 373.15))
    with np.errstate(divide="ignore"):
        inverse = np.where(network.k_cell > 0.0, 1.0 / np.maximum(k, 1e-3), 0.0)
    ci, cj = network.ci, network.cj
    conduct = 1.0 / (network.ri * inverse[ci] + network.rj * inverse[cj] + loads.contact)
    fi, fj = network.fi, network.fj
    inner = network.fr * inverse[fi]
    with np.errstate(divide="ignore"):
        exchange = np.where(
            loads.film > 0.0, 1.0 / (1.0 / np.maximum(loads.film, 1e-12) / network.fa + inner), 0.0
        )
    closed = fj >= 0
    diagonal, right = np.zeros(n), loads.source + loads.entry
    np.add.at(diagonal, ci, conduct)
    np.add.at(diagonal, cj, conduct)
    np.add.at(diagonal, fi, exchange)
    np.add.at(diagonal, fj[closed], exchange[closed])
    np.add.at(right, fi, exchange * np.where(closed, loads.offset, loads.outside))
    np.add.at(right, fj[closed], -(exchange * loads.offset)[closed])
    rows = [ci, cj, fi[closed], fj[closed], np.arange(n)]
    columns = [cj, ci, fj[closed], fi[closed], np.arange(n)]
    values = [-conduct, -conduct, -exchange[closed], -exchange[closed], diagonal]
    leaving = np.zeros(n)
    streams = [stream for stream in loads.streams if stream[2] != 0.0]
    if streams:
        start = np.array([s[0] for s in streams])
        end = np.array([s[1] for s in streams])
        flow = np.array([s[2] for s in streams])
        out = start >= 0
        np.add.at(leaving, start[out], flow[out])
        inside = out & (end >= 0)
        rows.append(end[inside])
        columns.append(start[inside])
        values.append(-flow[inside])
        diagonal += leaving
    stored = np.zeros(n) if previous is None else network.c_cell / step
    diagonal += stored
    if previous is not None:
        right += stored * previous
    matrix = sp.csc_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n)
    )
    # a cold reference keeps the numbers of the balance small
    shift = float(np.mean(guess))
    temperature = shift + splu(
        matrix, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}, diag_pivot_thresh=0.01
    ).solve(right - matrix @ np.full(n, shift))
    fluid = np.where(closed, temperature[np.maximum(fj, 0)] + loads.offset, loads.outside)
    heat = exchange * (temperature[fi] - fluid)
    exits = sum(c * temperature[a] for a, b, c in streams if a >= 0 and b < 0)
    kept = float(np.sum(stored * (temperature - previous))) if previous is not None else 0.0
    gained = float(np.sum(loads.source) + np.sum(loads.entry))
    lost = float(np.sum(heat[~closed])) + exits + kept
    scale = float(np.sum(np.abs(loads.source)) + np.sum(np.abs(heat[~closed])))
    return Solved(
        temperature=temperature, surface=temperature[fi] - heat * inner, film_heat=heat,
        imbalance=(gained - lost) / max(scale, 1.0),
    )  # fmt: skip
