"""Names of the parts of gearboxes: a gearbox and a part of it, written ``gearbox.part`` wherever they are text."""

from typing import Self


class PartName(str):
    """A part of a gearbox; equal to its text, so that it stands in keys, checks and files as such.

    >>> name = MeshName("test", "main")
    >>> name, name.gearbox, name.part
    ('test.main', 'test', 'main')
    """

    gearbox: str
    part: str

    def __new__(cls, gearbox: str, part: str) -> Self:
        """The name of a part of a gearbox."""
        name = super().__new__(cls, f"{gearbox}.{part}")
        name.gearbox, name.part = gearbox, part
        return name

    def __reduce__(self) -> tuple[type[Self], tuple[str, str]]:
        """Packed by its two parts."""
        return type(self), (self.gearbox, self.part)

    @property
    def both(self) -> tuple[str, str]:
        """Gearbox and part."""
        return self.gearbox, self.part

    @classmethod
    def read(cls, text: str) -> Self:
        """The name that a text, ``gearbox.part``, of a user or a key stands for."""
        gearbox, _, part = text.partition(".")
        return cls(gearbox, part)


class MeshName(PartName):
    """A mesh."""


class GearName(PartName):
    """A gear."""


class BearingName(PartName):
    """A bearing."""


class OilStreamName(PartName):
    """An oil stream: ``gear_oil`` or ``bearing_oil`` of a gearbox."""
