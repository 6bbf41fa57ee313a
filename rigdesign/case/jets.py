"""Oil jets of a gearbox as they reach the meshes: what is fed less leaks, through the nozzles that are open."""

from dynamics.losses.oil_jet import JET_ANGLES, OilJet
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.lubrication import JetOil
from rigdesign.properties.oil import Oil


def injected_flow(box: Gearbox) -> float:
    """Flow of the jets of one mesh [m3/s]: what is fed less what goes round the meshes; zero without jets."""
    return 0.0 if box.jets is None else (1.0 - box.oil_paths.bypass) * box.jets.flow


def jet_velocity(box: Gearbox, jets: JetOil) -> float:
    """Velocity of the oil in the jets [m/s]: that of the case with its flow through all of them."""
    return (1.0 - box.oil_paths.bypass) / (1.0 - jets.blocked_jets) * jets.jet_velocity


def mesh_jet(box: Gearbox, jets: JetOil, oil: Oil) -> OilJet:
    """Jet of one mesh, at the inlet temperature of the case; ``oil`` in its state in the gearbox."""
    return OilJet(
        flow=injected_flow(box),
        density=oil.density(jets.inlet_temperature),
        speed=jet_velocity(box, jets),
        angle=JET_ANGLES[jets.jet_direction],
    )
