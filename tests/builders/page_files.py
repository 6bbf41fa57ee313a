"""Files and commands that a page of the documentation shows, so that tests run what is printed."""

import re
import shlex
from pathlib import Path


def written_out(page: str, folder: Path) -> None:
    """Every file the page shows, by the name after its fence."""
    for name, text in re.findall(r"^```\w+ (\S+)\n(.*?)^```", page, re.DOTALL | re.MULTILINE):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def commands(page: str) -> list[list[str]]:
    """Arguments of every `rigdesign` command in the blocks of the page marked ``sh``."""
    blocks = re.findall(r"^```sh\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    lines = [shlex.split(line) for block in blocks for line in block.splitlines()]
    assert all(line[0] == "rigdesign" for line in lines)
    return [line[1:] for line in lines]
