"""Influence numbers kept on disk by the cold gear they belong to.

A file is named after the hash of the gear model and begins with the hash of that and of what follows, an archive of
arrays. A file that is damaged, cut off or of another gear is not used: its numbers are computed again and replace it.
Deleting the folder loses time only. A gear is computed by one process at a time; others that need it wait for it.
"""

import hashlib
import io
import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dynamics.influence.build import influence_numbers
from dynamics.influence.gear_model import GearModel
from dynamics.influence.numbers import InfluenceNumbers, RootFillet
from rigdesign.base.file_lock import FileLock, HeldError
from rigdesign.base.output_folder import replace_whole
from thermal.fe.kernel_cache import cache_folder

Array = NDArray[np.float64]
Progress = Callable[[str], None]

SCHEMA = 4
"""Of the numbers and of how they are computed; raise it with any change of either."""
ABSENT = (FileNotFoundError, NotADirectoryError)
POLL = 0.2
"""Between two looks whether another process has finished a gear [s]."""
SEAL = 64
"""Length of the hash at the beginning of a file [bytes]."""


def silent(message: str) -> None:
    """Say nothing."""


@dataclass(frozen=True)
class InfluenceStore:
    """Stored numbers in a folder."""

    folder: Path

    @classmethod
    def default(cls) -> "InfluenceStore":
        """In RIGDESIGN_CACHE_DIR or the user's cache folder."""
        return cls(cache_folder() / "influence")

    def numbers(self, model: GearModel, say: Progress = silent) -> InfluenceNumbers:
        """Numbers of a gear, stored or computed now and stored.

        say : called before they are computed, and for a file that cannot be used
        """
        found = self.stored(model, say)
        if found is not None:
            return found
        say(f"influence numbers of {gear_words(model)}")
        return self.compute(model)

    def stored(self, model: GearModel, say: Progress = silent) -> InfluenceNumbers | None:
        """Numbers of a gear that are stored, or None; ``say`` is called for a file that cannot be used."""
        file = self.file(model)
        try:
            found = _numbers_in(file.read_bytes(), identity(model))
            fault = "" if found is not None else "is damaged or of another gear"
        except ABSENT:
            return None
        except OSError as error:
            found, fault = None, f"cannot be read ({error.strerror})"
        if fault:
            say(f"{file} {fault}: its influence numbers are computed again")
        return found

    def compute(self, model: GearModel) -> InfluenceNumbers:
        """Numbers of a gear, computed now and stored, or read where another process has done so meanwhile."""
        with self._alone(model):
            found = self.stored(model)
            if found is not None:
                return found
            made = influence_numbers(model)
            # a cache that cannot be written costs time only
            with suppress(OSError):
                _write(self.file(model), identity(model), made)
            return made

    def in_progress(self, model: GearModel) -> bool:
        """Whether another process is computing the numbers of a gear."""
        lock = self._lock(model)
        try:
            if lock.exists():
                FileLock(lock).release()
        except HeldError:
            return True
        except OSError:
            return False
        return False

    def file(self, model: GearModel) -> Path:
        """Where the numbers of a gear are kept."""
        return self.folder / f"{identity(model)[:32]}.influence"

    def _lock(self, model: GearModel) -> Path:
        return self.file(model).with_suffix(".lock")

    @contextmanager
    def _alone(self, model: GearModel) -> Iterator[None]:
        """While no other process computes this gear; at once where no lock can be had: both then compute it."""
        lock: FileLock | None = None
        with suppress(OSError):
            self.folder.mkdir(parents=True, exist_ok=True)
            while lock is None:
                try:
                    lock = FileLock(self._lock(model))
                except HeldError:
                    time.sleep(POLL)
        try:
            yield
        finally:
            if lock is not None:
                lock.release()


def identity(model: GearModel) -> str:
    """Hash of everything the numbers of a gear follow from."""
    # json writes numbers of numpy and of Python alike, to the last digit
    return hashlib.sha256(json.dumps([SCHEMA, asdict(model)], default=int).encode()).hexdigest()


def gear_words(model: GearModel) -> str:
    """The gear as a user knows it."""
    gear = model.form.gear
    return f"the gear with {gear.teeth} teeth, module {1e3 * gear.normal_module:g} mm"


def _entries(numbers: InfluenceNumbers) -> dict[str, Array]:
    """Arrays of a file; displacements against the direction of counting follow from reciprocity."""
    entries = {
        "profile": numbers.profile,
        "face": numbers.face,
        "axis_depth": numbers.axis_depth,
        "local_excess": numbers.local_excess,
        "body": numbers.body,
        "point": numbers.fillet.point,
        "arc": numbers.fillet.arc,
        "tangent": numbers.fillet.tangent,
        "measures": np.array([numbers.asymmetry, float(numbers.n_nodes)]),
    }
    entries |= {f"deflection {k}": block for k, block in numbers.deflection.items() if k >= 0}
    return entries | {f"stress {k} {side}": block for (k, side), block in numbers.stress.items()}


def _from_entries(entries: Mapping[str, Array]) -> InfluenceNumbers:
    deflection = {
        int(name.split()[1]): block for name, block in entries.items() if name.startswith("deflection")
    }
    deflection |= {-k: np.ascontiguousarray(block.T) for k, block in deflection.items() if k > 0}
    stress = {
        (int(name.split()[1]), int(name.split()[2])): block
        for name, block in entries.items()
        if name.startswith("stress")
    }
    asymmetry, n_nodes = entries["measures"].tolist()
    return InfluenceNumbers(
        profile=entries["profile"],
        face=entries["face"],
        axis_depth=entries["axis_depth"],
        local_excess=entries["local_excess"],
        deflection=deflection,
        body=entries["body"],
        fillet=RootFillet(point=entries["point"], arc=entries["arc"], tangent=entries["tangent"]),
        stress=stress,
        asymmetry=asymmetry,
        n_nodes=round(n_nodes),
    )


def _seal(key: str, archive: bytes) -> bytes:
    """Hash of an archive and of the gear it belongs to, (SEAL,) hexadecimal digits."""
    return hashlib.sha256(key.encode() + archive).hexdigest().encode()


def _numbers_in(content: bytes, key: str) -> InfluenceNumbers | None:
    """Numbers of a file; None for one that is damaged or of another gear."""
    seal, archive = content[:SEAL], content[SEAL:]
    if seal != _seal(key, archive):
        return None
    with np.load(io.BytesIO(archive), allow_pickle=False) as arrays:
        return _from_entries({name: arrays[name] for name in arrays.files})


def _write(file: Path, key: str, numbers: InfluenceNumbers) -> None:
    """Store numbers: whole or not at all, also while others write the same."""
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **_entries(numbers))
    archive = stream.getvalue()
    replace_whole(file, _seal(key, archive) + archive)
