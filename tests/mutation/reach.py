"""Which test files run a line: by the imports for the order in which to ask them, by coverage for the answer.

Every test file is run once by itself under coverage, when it is first asked for, and what it runs is kept in the
working folder with the seconds it takes. Compiled kernels are invisible to coverage: their lines count as run where
a line that uses a name of their module is run.
"""

import ast
import json
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from coverage import CoverageData

from tests.mutation.sample import PACKAGES, ROOT, modules, source

FOLDERS = ("tests/unit", "tests/verification")
"""Not the shipped cases against their expected results: those move with everything and say nothing of what is right."""
LEFT_OUT = (
    "tests/unit/rigdesign_package/test_packaging.py",
    "tests/unit/dynamics_package/kernels/test_kernel_cache.py",
)
"""Builds wheels; counts compilations."""
Lines = Mapping[str, frozenset[int]]


@dataclass(frozen=True)
class Reach:
    """What one test file runs."""

    seconds: float
    passed: bool
    lines: Lines
    """By module."""


def measured(file: str, folder: Path) -> Reach:
    """What a test file runs, from the folder if it has been asked before."""
    kept = folder / "reach" / f"{Path(file).stem}.json"
    if not kept.is_file():
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(_measure(file, kept.with_suffix(".coverage"))), encoding="utf-8")
    found = json.loads(kept.read_text(encoding="utf-8"))
    lines = {module: frozenset(numbers) for module, numbers in found["lines"].items()}
    return Reach(seconds=found["seconds"], passed=found["passed"], lines=lines)


def _measure(file: str, data: Path) -> dict[str, object]:
    started = time.perf_counter()
    command = [sys.executable, "-m", "coverage", "run", f"--data-file={data}", f"--source={','.join(PACKAGES)}",
               "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", file]  # fmt: skip
    passed = subprocess.run(command, cwd=ROOT, capture_output=True, check=False).returncode == 0
    seconds = time.perf_counter() - started
    found = CoverageData(str(data))
    found.read()
    lines = {
        Path(path).relative_to(ROOT).as_posix(): sorted(found.lines(path) or ())
        for path in found.measured_files()
    }
    data.unlink()
    return {"seconds": round(seconds, 1), "passed": passed, "lines": lines}


def runs(reach: Reach, module: str, lines: tuple[int, int]) -> bool:
    """Whether a test file runs one of the lines first to last of a module."""
    if not is_kernel(module):
        return any(lines[0] <= line <= lines[1] for line in reach.lines.get(module, ()))
    return any(not numbers.isdisjoint(reach.lines.get(user, ())) for user, numbers in _users(module))


def is_kernel(module: str) -> bool:
    """Whether a module holds compiled functions."""
    return "njit" in source(module)


@cache
def _users(kernel: str) -> tuple[tuple[str, frozenset[int]], ...]:
    """(module, lines) outside compiled code that use a kernel module, or a kernel or package that hands it on."""
    found, asked, waiting = [], {kernel}, [kernel]
    while waiting:
        used = waiting.pop()
        for module in modules():
            names = {name for name, target in _imports(module) if target == used}
            if not names or module in asked:
                continue
            if is_kernel(module) or module.endswith("__init__.py"):
                asked.add(module)
                waiting.append(module)
            found.append((module, _lines_in_functions(module, names)))
    return tuple(found)


def _lines_in_functions(module: str, names: set[str]) -> frozenset[int]:
    functions = (
        node
        for node in ast.walk(ast.parse(source(module)))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    )
    inside = (node for function in functions for statement in function.body for node in ast.walk(statement))
    return frozenset(node.lineno for node in inside if isinstance(node, ast.Name) and node.id in names)


@cache
def _imports(path: str) -> tuple[tuple[str, str], ...]:
    """(name as used, file it comes from) of everything of the project that a file imports."""
    return tuple(_imported(ast.parse((ROOT / path).read_text(encoding="utf-8"))))


def _imported(tree: ast.Module) -> Iterator[tuple[str, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield from ((alias.asname or alias.name.split(".")[0], file) for file in _file(alias.name))
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                files = _file(f"{node.module}.{alias.name}") or _file(node.module)
                yield from ((alias.asname or alias.name, file) for file in files)


def _file(name: str) -> list[str]:
    stem = name.replace(".", "/")
    return [file for file in (f"{stem}.py", f"{stem}/__init__.py") if (ROOT / file).is_file()]


@cache
def test_files() -> tuple[str, ...]:
    """Every test file that may be asked."""
    found = (
        path.relative_to(ROOT).as_posix() for folder in FOLDERS for path in (ROOT / folder).glob("test_*.py")
    )
    return tuple(sorted(file for file in found if file not in LEFT_OUT))


@cache
def nearest(module: str) -> tuple[str, ...]:
    """Test files by how many imports lie between them and a module, of equals those that import less of the project.

    Those without a way to it are left out.
    """
    found = [(steps[module], len(steps), file) for file in test_files() if module in (steps := _steps(file))]
    return tuple(file for _, _, file in sorted(found))


@cache
def _steps(file: str) -> Mapping[str, int]:
    found, layer = {file: 0}, [file]
    while layer:
        further = dict.fromkeys(
            target for path in layer for _, target in _imports(path) if target not in found
        )
        found |= dict.fromkeys(further, found[layer[0]] + 1)
        layer = list(further)
    return found
