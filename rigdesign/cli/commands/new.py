"""`rigdesign new`: the start of a file to fill in."""

from pathlib import Path

from cyclopts import App

from rigdesign.cli.application import OutFolder, app, loaded_case

new = App(name="new", help="Write the start of a file to fill in.")
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
