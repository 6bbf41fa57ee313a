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
    return [arguments for arguments, _ in shown(page)]


def shown(page: str) -> list[tuple[list[str], list[str]]]:
    """Arguments of every `rigdesign` command of the page, with the lines that the page shows as its output.

    These stand in a block marked ``text`` right after that of the command; empty where there is none.
    """
    found = re.findall(r"^```sh\n(.*?)^```$(?:\n\n^```text\n(.*?)^```$)?", page, re.DOTALL | re.MULTILINE)
    pairs: list[tuple[list[str], list[str]]] = []
    for block, text in found:
        lines = [shlex.split(line) for line in block.splitlines()]
        assert all(line[0] == "rigdesign" for line in lines)
        pairs += [(line[1:], []) for line in lines[:-1]]
        pairs.append((lines[-1][1:], text.splitlines()))
    return pairs


def missing_lines(wanted: list[str], output: str) -> list[str]:
    """Lines of a page that an output does not hold, in their order; numbers may differ by a per cent.

    A line ``…`` stands for any lines, ``…`` at the end of a line for the rest of it.
    """
    left = iter(output.splitlines())
    return [line for line in wanted if line != "…" and not any(_alike(line, found) for found in left)]


def _alike(shown_line: str, printed: str) -> bool:
    words, found = shown_line.split(), printed.split()
    if words and words[-1] == "…" and len(words) <= len(found) + 1:
        words, found = words[:-1], found[: len(words) - 1]
    return len(words) == len(found) and all(_same(word, other) for word, other in zip(words, found))


def _same(word: str, other: str) -> bool:
    """The same word, or numbers within a per cent with the same signs around them."""
    number = re.compile(r"\d+(?:\.\d+)?")
    if number.sub("#", word) != number.sub("#", other):
        return False
    pairs = zip(number.findall(word), number.findall(other))
    return all(abs(float(one) - float(two)) <= 0.01 * abs(float(one)) for one, two in pairs)
