"""`rigdesign new`: the start of a file to fill in, and a case from a few numbers."""

import sys
from pathlib import Path

from cyclopts import App

from rigdesign.cli.application import OutFolder, app, loaded_case

new = App(name="new", help="Write a case from a few numbers, or the start of a measurement set.")
app.command(new)


@new.command(name="measurement")
def new_measurement(case: Path, /, *, out: OutFolder) -> int:
    """Write measurement.toml and an empty data.csv with the channels the case offers.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    out
        Folder of the set; files in it are not overwritten.
    """
    loaded = loaded_case(case)
    from rigdesign.measurement.template import write_template

    for path in write_template(loaded, out):
        print(path)
    return 0


@new.command(name="case")
def new_case(
    *,
    out: OutFolder,
    teeth: str | None = None,
    module: str | None = None,
    centre_distance: str | None = None,
    face_width: str | None = None,
    torque: str | None = None,
    speed: str | None = None,
    bearings: str | None = None,
    oil: str | None = None,
    oil_temperature: str | None = None,
    lubrication: str | None = None,
    box: str | None = None,
    profile_shift: str | None = None,
    name: str | None = None,
) -> int:
    """Write the case of a back-to-back rig of two gearboxes, with a comment at every key.

    What is left out is asked for where the command runs in a terminal. Everything else of the case is a default of the
    tool, marked as an assumption with its reason and range.

    Parameters
    ----------
    out
        Folder of the case; files in it are not overwritten.
    teeth
        Teeth of pinion and wheel, e.g. 16,24.
    module
        Normal module, e.g. "4.5 mm".
    centre_distance
        Centre distance, e.g. "91.5 mm".
    face_width
        Face width of the test gears, e.g. "14 mm"; the slave gears get twice as much.
    torque
        Test torque at the pinion, e.g. "300 N m".
    speed
        Test speed of the pinion, e.g. "2250 rpm".
    bearings
        Journal diameter of plain bearings, e.g. "40 mm", or the designation of rolling bearings.
    oil
        Oil by its built-in name, e.g. "FVA 3A".
    oil_temperature
        Temperature of the oil at the inlet, or of the sump, e.g. "60 degC".
    lubrication
        jet or dip; jet when left out.
    box
        Outer length x width x height of the test gearbox, e.g. "200 x 280 x 220 mm"; without it there is no temperature
        field.
    profile_shift
        Profile shift of the pinion in modules; when left out both gears share that of the centre distance.
    name
        Short name of the case; that of the folder when left out.
    """
    given = {
        "teeth": teeth, "module": module, "centre_distance": centre_distance, "face_width": face_width,
        "torque": torque, "speed": speed, "bearings": bearings, "oil": oil, "oil_temperature": oil_temperature,
        "lubrication": lubrication, "box": box, "profile_shift": profile_shift, "name": name,
    }  # fmt: skip
    from rigdesign.new_case.outline import QUESTIONS, outline_from
    from rigdesign.new_case.write import free_paths, write_case

    free_paths(out)
    answers = {key: value for key, value in given.items() if value is not None}
    default_name = {"name": _name_of(out)}
    missing = any(question.required and question.key not in answers for question in QUESTIONS)
    if missing and sys.stdin.isatty():
        from rigdesign.cli.terminal.case_dialogue import ask_for_case

        paths = ask_for_case(answers, lambda answered: write_case(outline_from(default_name | answered), out))
    else:
        paths = write_case(outline_from(default_name | answers), out)
    for path in paths:
        print(path)
    return 0


def _name_of(out: Path) -> str:
    """Name of the folder as that of a case, where it makes one."""
    import re

    name = re.sub(r"[^a-z0-9_]+", "_", out.absolute().name.lower()).strip("_")
    return name if re.match(r"[a-z]", name) else "my_rig"
