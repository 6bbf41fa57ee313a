"""Oil of a gearbox as it is: its state, and what of it reaches meshes, walls and bearings."""

from dataclasses import dataclass

from rigdesign.case.gearbox import Gearbox
from rigdesign.properties.oil import Oil
from rigdesign.rig.model import Rig


def gear_oil(rig: Rig, name: str) -> Oil:
    """Oil injected in the gearbox ``name``, in its state there."""
    box = rig.case.gearboxes[name]
    return _in_state(rig.oils[box.oil.oil], box)


def bearing_oil(rig: Rig, name: str) -> Oil:
    """Oil of the bearings of the gearbox ``name``, in its state there."""
    box = rig.case.gearboxes[name]
    return _in_state(rig.oils[box.bearing_oil.oil], box)


@dataclass(frozen=True, kw_only=True)
class OilFeed:
    """Oil as it is fed to a consumer: in its state there, at its inlet temperature."""

    oil: Oil
    inlet: float
    """[K]"""
    flow: float
    """[m3/s]"""

    @property
    def mass_flow(self) -> float:
        """[kg/s]"""
        return self.oil.density(self.inlet) * self.flow

    @property
    def capacity_rate(self) -> float:
        """Heat that warms it by one kelvin, rho c Q with properties at the inlet [W/K]."""
        return self.oil.density(self.inlet) * self.oil.heat_capacity(self.inlet) * self.flow

    def mean(self, outlet: float) -> float:
        """Mean temperature of inlet and ``outlet`` [K]."""
        return 0.5 * (self.inlet + outlet)


def gear_feed(rig: Rig, name: str) -> OilFeed:
    """Oil fed to all meshes of the gearbox ``name``."""
    box = rig.case.gearboxes[name]
    return OilFeed(
        oil=gear_oil(rig, name), inlet=box.oil.inlet_temperature, flow=box.oil.flow * len(box.meshes)
    )


def bearing_feed(rig: Rig, name: str) -> OilFeed:
    """Oil fed to each bearing of the gearbox ``name``."""
    feed = rig.case.gearboxes[name].bearing_oil
    return OilFeed(oil=bearing_oil(rig, name), inlet=feed.inlet_temperature, flow=feed.flow)


def conducting_share(rig: Rig, name: str, stream: str) -> float:
    """Conductivity of an oil of the gearbox ``name`` over that of its data sheet; ``stream``: gear_oil, bearing_oil."""
    box = rig.case.gearboxes[name]
    clear = rig.oils[(box.oil if stream == "gear_oil" else box.bearing_oil).oil]
    return _in_state(clear, box).conductivity_40 / clear.conductivity_40


def _in_state(oil: Oil, box: Gearbox) -> Oil:
    state = box.oil_state
    return oil.in_state(
        air_content=state.air_content,
        viscosity_factor=state.viscosity_factor,
        heat_capacity_factor=state.heat_capacity_factor,
    )


def injected_flow(box: Gearbox) -> float:
    """Flow of the jets of one mesh [m3/s]: what is fed less what goes round the meshes."""
    return (1.0 - box.oil_paths.bypass) * box.oil.flow


def jet_velocity(box: Gearbox) -> float:
    """Velocity of the oil in the jets [m/s]: that of the case with its flow through all of them."""
    return (1.0 - box.oil_paths.bypass) / (1.0 - box.oil.blocked_jets) * box.oil.jet_velocity


def wetting_flow(box: Gearbox) -> float:
    """Flow of one mesh over the share of the face width its open jets reach [m3/s]: all of it lands there."""
    return injected_flow(box) / (1.0 - box.oil.blocked_jets)


def wetted_width(box: Gearbox) -> float:
    """Share of the face width that the open jets reach."""
    return 1.0 - box.oil.blocked_jets


def wall_flow(box: Gearbox) -> float:
    """Gear oil that passes walls, shafts and gear bodies on its way out, of all meshes [m3/s]."""
    paths = box.oil_paths
    return (1.0 - paths.bypass - paths.short_circuit) * box.oil.flow * len(box.meshes)
