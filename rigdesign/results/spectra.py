"""Spectra of the mesh torque from the time run and the periodic response: SI records."""

from dataclasses import dataclass

Row = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Waterfall:
    """Amplitude of the torque of one mesh over frequency and speed in a run-up or run-down."""

    mesh: str
    """Its label."""
    stage: str
    speed: Row
    """(s,) of the pinion of the mesh, rising [rad/s]"""
    frequency: Row
    """(f,) middles of the bins [Hz]"""
    amplitude: tuple[Row, ...]
    """(s, f) largest in each cell [N m]"""
    per_turn: float
    """Mesh frequency per turning frequency of the pinion [-]."""


@dataclass(frozen=True, kw_only=True)
class HeldSpectrum:
    """Torque of one mesh at a held stage over the order of its pinion."""

    mesh: str
    stage: str
    speed: float
    """Of the pinion of the mesh [rad/s]."""
    mean: float
    """[N m]"""
    order: Row
    """(n,) of the time run, as far as its torque is kept: three mesh orders of the highest speed."""
    amplitude: Row
    """(n,) largest around each order [N m]"""
    harmonic_order: Row
    """(h,) of the periodic response: mesh orders, and those between them where its period is longer than a mesh."""
    harmonic_amplitude: Row
    """(h,) [N m]"""
    teeth: int
    """Of the pinion: order of the mesh frequency."""
