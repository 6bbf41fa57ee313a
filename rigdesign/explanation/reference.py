"""The key reference: every key of the case file by table, generated from the schema."""

from collections.abc import Iterator

from rigdesign.case.defaults.known import WRITTEN_ONCE
from rigdesign.explanation.keys import NAMED, NUMBERED, KeyEntry, case_keys

HEADER = f"""\
# Keys of a case file

Generated from the schema by `rigdesign schema --reference`; a test holds it current.
`{NAMED}` stands for the name of a part, `{NUMBERED}` for the number of an item in a list. A quantity is a text
with a unit, `"7 mm"`; any value may be a table that says where it comes from:
`{{ value = …, source = …, assumed = …, range = […], measured = … }}`.
`rigdesign explain CASE PATH` says what a key is in one case and which checks depend on it.

A key whose default is `by the tool` may be left out: its value is worked out from the rest of the case and stands in
the report as an assumption with its reason and range, "default of the tool: …". What is stated is never touched.
Equal parts are written once, in a table of `gearboxes`:

"""


def key_reference() -> str:
    """The reference as Markdown: a section for every table, a row for every key."""
    written_once = "".join(f"- `{key}`: {text}\n" for key, (_, text) in WRITTEN_ONCE.items())
    return "\n".join([HEADER + written_once, *_sections()])


def _sections() -> Iterator[str]:
    entries = case_keys()
    tables = {(entry.path, entry.variant): entry for entry in entries if entry.table}
    groups: dict[tuple[str, str], list[KeyEntry]] = {}
    for entry in entries:
        if not entry.path.endswith((f".{NAMED}", f".{NUMBERED}")):
            groups.setdefault((entry.path.rpartition(".")[0], entry.variant), []).append(entry)
    for (path, variant), keys in groups.items():
        yield f"## {path or 'case'}" + (f" with {variant}" if variant else "") + "\n"
        table = tables.get((path, variant)) or tables.get((path, ""))
        if table is not None and table.description:
            yield f"{_cell(table.description)}\n"
        yield "| key | holds | default | what it is |\n|---|---|---|---|"
        yield from (_row(key) for key in keys)
        yield ""


def _row(key: KeyEntry) -> str:
    name = key.path.rpartition(".")[2]
    units = f" [{', '.join(key.units)}]" if key.units else ""
    bounds = f", {key.bounds}" if key.bounds else ""
    default = key.default_text if key.required or key.filled_in or key.default is None else f"`{key.default}`"
    return f"| `{name}` | {_cell(key.kind + units + bounds)} | {_cell(default)} | {_cell(key.description)} |"


def _cell(text: str) -> str:
    return text.replace("``", "`").replace("|", "\\|")
