"""Where every key of the case enters the flow: module by module, with the physics it takes part in.

The nearest entry counts: of the key itself, else of its table. Every table has an entry, so that a new one has to say
where it enters. ``*`` stands for a name.
"""

from collections.abc import Mapping

from rigdesign.explanation.drivetrain_stations import DRIVETRAIN_STATIONS
from rigdesign.explanation.gearbox_stations import GEARBOX_STATIONS
from rigdesign.explanation.housing_stations import HOUSING_STATIONS
from rigdesign.explanation.run_stations import RUN_STATIONS
from rigdesign.explanation.station import Station

STATIONS: Mapping[str, tuple[Station, ...]] = {
    **RUN_STATIONS,
    **DRIVETRAIN_STATIONS,
    **GEARBOX_STATIONS,
    **HOUSING_STATIONS,
}


def entering(path: str) -> tuple[Station, ...]:
    """Stations of a key, by its path with ``*`` for names; KeyError where no entry holds it or its table."""
    table = path.rpartition(".")[0]
    return STATIONS[path] if path in STATIONS else STATIONS[table]
