"""At which places of a case the families of rules hold: known before anything is solved."""

from collections.abc import Iterator

from rigdesign.case.gearbox import Gearbox
from rigdesign.case.model import Case
from rigdesign.results.check import Role


def whole_rig(case: Case) -> tuple[str, ...]:
    """One rule of the rig."""
    return ("",)


def meshes(case: Case) -> Iterator[str]:
    """Every mesh: its gearbox, or ``gearbox.mesh`` where that has several."""
    for _, label, _ in _meshes(case):
        yield label


def meshes_of(role: Role, case: Case) -> Iterator[str]:
    """Every mesh of the gearboxes with a role."""
    return (label for box, label, _ in _meshes(case) if box.role == role)


def gears_of(role: Role, case: Case) -> Iterator[str]:
    """Pinion and wheel of every mesh of the gearboxes with a role: ``mesh.gear``."""
    for box, label, mesh in _meshes(case):
        if box.role == role:
            yield f"{label}.{box.meshes[mesh].pinion}"
            yield f"{label}.{box.meshes[mesh].wheel}"


def specimen_gears(case: Case) -> Iterator[str]:
    """Gears that are tested."""
    return gears_of("specimen", case)


def rig_gears(case: Case) -> Iterator[str]:
    """Gears of the rig itself."""
    return gears_of("rig", case)


def couplings(case: Case) -> tuple[str, ...]:
    """Every coupling of the drivetrain."""
    return tuple(case.power_circuit.couplings)


def housings(case: Case) -> Iterator[str]:
    """Every gearbox with a housing."""
    return (name for name, box in case.gearboxes.items() if box.housing is not None)


def housed_seals(case: Case) -> Iterator[str]:
    """Seals of the gearboxes with a housing: ``gearbox.seals``."""
    return (f"{name}.{seals}" for name in housings(case) for seals in case.gearboxes[name].seals)


def _meshes(case: Case) -> Iterator[tuple[Gearbox, str, str]]:
    """Gearbox, label in results and own name of every mesh."""
    for name, box in case.gearboxes.items():
        for mesh in box.meshes:
            yield box, name if len(box.meshes) == 1 else f"{name}.{mesh}", mesh
