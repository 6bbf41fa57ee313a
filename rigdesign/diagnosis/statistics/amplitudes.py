"""Amplitudes of what is not an effect: dimensionless, fitted to healthy sets of an independent simulator.

They are relative spreads and ratios to the level of a series, so that what one rig taught serves another; how well
they transfer is part of the score (README, diagnosis).
"""

from dataclasses import asdict, dataclass, replace


@dataclass(frozen=True, kw_only=True)
class Amplitudes:
    """Standard deviation of each kind of cause, relative."""

    constant_loss: float = 1.0
    """Factor on the healthy spreads of losses as the catalogue states them."""
    constant_film: float = 1.0
    """Factor on the healthy spreads of films, contacts and the division of heat."""
    constant_oil: float = 1.0
    """Factor on the healthy spreads of properties and ways of the oil."""
    constant_loop: float = 1.0
    """Factor on the healthy spreads of stiffness, damping and inertia."""
    tooth: float = 1.0
    """Factor on the healthy errors of the teeth, from their quality grade."""
    exponent: float = 0.15
    """Error of the exponent of a loss law over speed and torque."""
    link: float = 0.25
    """Error of the logarithm of every local conductance."""
    link_speed: float = 0.10
    """Error of the logarithm of every local conductance per factor e of speed."""
    answer: float = 0.15
    """Error of the answers to constants of the heat, over the answers at their healthy spreads."""
    source: float = 0.03
    """Heat that enters elsewhere than the model says, over all losses of the point."""
    channel: float = 0.02
    """Smooth error of one channel over its level: place of a sensor, what the mesh does not resolve."""
    channel_speed: float = 0.01
    """Smooth error of one channel per factor e of speed."""
    point: float = 0.01
    """Error of one number by itself over its level."""
    series_mean: float = 0.01
    """Error of a mean torque over its level."""
    series_mesh: float = 0.25
    """Orders of the meshes over their own level: coherent over the points."""
    series_mesh_point: float = 0.15
    """Orders of the meshes over their own level: point by point."""
    series_shaft: float = 0.01
    """Orders of the shafts and sidebands over the level of the mesh orders: coherent."""
    series_shaft_point: float = 0.01
    """Orders of the shafts and sidebands over the level of the mesh orders: point by point."""
    frequency: float = 0.02
    """Error of natural frequencies, relative."""
    sensor: float = 1.0
    """Factor on the systematic uncertainties of sensors that the measurement states."""
    input: float = 1.0
    """Factor on the systematic uncertainties of settings that the measurement states."""

    def as_dict(self) -> dict[str, float]:
        """By name."""
        return asdict(self)

    def with_values(self, values: dict[str, float]) -> "Amplitudes":
        """Some of them changed."""
        return replace(self, **values)
