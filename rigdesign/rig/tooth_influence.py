"""Influence numbers of the gears of a rig, of the cold teeth as drawn."""

import hashlib
import io
import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass, field, fields, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import PairGeometry
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.elastic_segment import FACE_POSITIONS, Elastic, GearModel
from dynamics.tooth.influence_model import influence_numbers
from dynamics.tooth.influence_numbers import GearBody, InfluenceNumbers, RootFillet
from rigdesign.base.output_folder import FileLock, HeldError, replace_whole
from rigdesign.base.parallel import BackgroundTasks, cores
from thermal.fe.kept_results import kept
from thermal.fe.kernel_cache import cache_folder

# Influence numbers kept on disk by the cold gear they belong to.
#
# A file is named after the hash of the gear model and begins with the hash of that and of what follows, an archive of
# arrays. A file that is damaged, cut off or of another gear is not used: its numbers are computed again and replace it.
# Deleting the folder loses time only. A gear is computed by one process at a time; others that need it wait for it.

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


INTEGRAL = 0.5
"""Radius at which a gear that is one with its shaft is held, as a share of its root radius: the shaft has the rest."""

QUICK_POSITIONS = 7
"""Positions over the face at fidelity quick."""

NEEDED = 2.5e9
"""Memory in which the numbers of a gear are computed [bytes]."""

Count = Callable[[int, int, str], None]
Numbers = tuple[InfluenceNumbers, InfluenceNumbers]
Compliances = tuple[InterpolatedCompliance, InterpolatedCompliance]


@dataclass(frozen=True)
class ToothInfluence:
    """Influence numbers of gear pairs, each gear once.

    positions : over the face of every gear
    near : gears whose numbers also serve gears that differ from them in face width alone, for searches over it
    """

    store: InfluenceStore = field(default_factory=InfluenceStore.default)
    positions: int = FACE_POSITIONS
    near: tuple[GearModel, ...] = ()
    _found: dict[GearModel, InfluenceNumbers] = field(default_factory=dict, compare=False, repr=False)

    def prepare(self, pairs: Iterable[GearPair], say: Progress = silent, count: Count | None = None) -> None:
        """Read the numbers of the gears of some pairs and compute what is missing, as many at a time as there is room.

        In copies of this process: where a compiled library with threads of its own has run in it, GNU OpenMP ends the
        copies, and their gears are computed here, one after the other.

        count : called with gears done, gears in all and the last one, from none on; ``say`` where it is left out
        """
        models = dict.fromkeys(
            self.known(gear_model(pair, index, self.positions)) for pair in pairs for index in (0, 1)
        )
        for model in models:
            found = None if model in self._found else self.store.stored(model, say)
            if found is not None:
                self._found[model] = found
        missing = [model for model in models if model not in self._found]
        if not missing:
            return
        # what another process computes comes last: it is read then
        missing.sort(key=self.store.in_progress)
        whole, at_once = len(missing), min(_at_once(), cores())
        say(f"influence numbers of gears not yet known: {whole}, 5 to 10 s each; then kept")
        count = count or (
            lambda done, whole, last: say(f"{done} of {whole} gears, last {last}") if done else None
        )
        count(0, whole, "")
        with ExitStack() as copies:
            begun: list[BackgroundTasks[InfluenceNumbers]] = []
            for done, model in enumerate(missing):
                begun.extend(
                    copies.enter_context(BackgroundTasks([partial(self.store.compute, new)]))
                    for new in missing[len(begun) : done + at_once]
                )
                (self._found[model],) = begun[done].results()
                count(done + 1, whole, gear_words(model))

    def of_pair(self, pair: GearPair) -> Numbers:
        """Numbers of pinion and wheel on the face positions of the contact: positive z comes into mesh last."""
        return _of_pair(self, pair)

    def compliances(self, pair: GearPair) -> Compliances:
        """Compliance of pinion and wheel in their contact."""
        return _compliances(self, pair)

    def for_widths_near(self, pairs: Iterable[GearPair]) -> "ToothInfluence":
        """The same where gears that differ from those of some pairs in face width alone take their numbers over."""
        near = dict.fromkeys(gear_model(pair, index, self.positions) for pair in pairs for index in (0, 1))
        return replace(self, near=tuple(near))

    def numbers(self, model: GearModel) -> InfluenceNumbers:
        """Numbers of one gear."""
        known = self.known(model)
        if known not in self._found:
            self._found[known] = self.store.numbers(known)
        numbers = self._found[known]
        return numbers if known == model else numbers.over_face_width(model.face_width)

    def known(self, model: GearModel) -> GearModel:
        """The gear itself, or the one whose numbers serve it."""
        if model in self.near:
            return model
        alike = (one for one in self.near if replace(model, face_width=one.face_width) == one)
        return next(alike, model)


def _at_once() -> int:
    """Gears computed at a time: `NEEDED` each, in half of the memory of the machine."""
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else NEEDED
    return max(1, int(0.5 * memory / NEEDED))


@kept
def _of_pair(influence: ToothInfluence, pair: GearPair) -> Numbers:
    pinion, wheel = (influence.numbers(gear_model(pair, index, influence.positions)) for index in (0, 1))
    return pinion.reversed_face(), wheel


@kept
def _compliances(influence: ToothInfluence, pair: GearPair) -> Compliances:
    pinion, wheel = (
        InterpolatedCompliance.of(numbers, pair.base_helix_angle) for numbers in _of_pair(influence, pair)
    )
    return pinion, wheel


def gear_model(pair: GearPair, index: int, positions: int = FACE_POSITIONS) -> GearModel:
    """Cold gear of a pair as drawn, pinion (0) or wheel (1); of a warm pair, that at its reference temperature."""
    drawn = {entry.name: getattr(pair, entry.name) for entry in fields(PairGeometry)}
    form = PairGeometry(**drawn | {"expansion": (0.0, 0.0)}).forms[index]
    bore, details = 0.5 * pair.bore_diameters[index], pair.details[index]
    held = INTEGRAL * form.root_radius
    if details.rim_thickness is not None:
        held = min(held, INTEGRAL * (form.root_radius - details.rim_thickness))
    return GearModel(
        form=form,
        body=GearBody(
            bore_radius=bore if bore > 0.0 else held,
            rim_thickness=details.rim_thickness,
            web_thickness=details.web_thickness,
        ),
        material=Elastic(young=pair.youngs_moduli[index], poisson=pair.poisson_ratios[index]),
        face_width=pair.face_widths[index],
        n_face=positions,
    )
