"""One place of the flow where a key of the case enters."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Station:
    """One place of the flow where a key enters."""

    module: str
    """Folder and module of the tool."""
    role: str
    """What the key does there."""


def stations_at(**roles: str) -> tuple[Station, ...]:
    """Stations by module, ``__`` for the slash after its folder, and role."""
    return tuple(Station(module.replace("__", "/"), role) for module, role in roles.items())
