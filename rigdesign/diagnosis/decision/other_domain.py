"""Whether the numbers of the other domain speak against an explanation.

Heat at an oil by which the orders of the meshes would be explained has to be there in the temperatures, and so has a
bracing that drifts with the oil in the mean torques. The model may answer wrongly there, too, by a factor.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from rigdesign.diagnosis.decision.evaluate import Explanations
from rigdesign.diagnosis.residual.signature import EXACT
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import SEEN
from rigdesign.diagnosis.statistics.evidence import JOIN, Evidence
from rigdesign.diagnosis.statistics.hypothesis import Hypothesis

WIDE = 2.0
"""Factor by which an answer of the model may be too small or too large in the other domain."""


@dataclass(frozen=True, kw_only=True)
class OtherDomain:
    """Numbers of the other domain, and what every single explanation leaves in them.

    own, there : name of a single explanation -> its hypothesis in this domain and in the other one
    """

    space: Whitened = field(repr=False)
    own: Mapping[str, Hypothesis] = field(repr=False)
    there: Mapping[str, Hypothesis] = field(repr=False)

    @classmethod
    def of(cls, space: Whitened, own: Explanations, there: Explanations) -> "OtherDomain":
        """By the explanations of either domain; ``space``: of the other one."""
        return cls(
            space=space,
            own={one.name: one for one in own.single},
            there={one.name: one for one in there.single},
        )

    def seen_from(self, own: Explanations) -> "OtherDomain":
        """The same beside a space with some causes in the model, in which unmodelled ones have other lengths."""
        return replace(self, own={one.name: one for one in own.single})

    def contradicts(self, one: Evidence) -> bool:
        """Whether the residual there grows by more than what is seen, whatever the factor on the answer."""
        answer, residual = self._answer(one), self.space.residual
        square = float(answer @ answer)
        if square <= SEEN**2:
            return False
        exact = one.hypothesis.family in EXACT
        factor = 1.0 if exact else float(np.clip(answer @ residual / square, 1.0 / WIDE, WIDE))
        return factor**2 * square - 2.0 * factor * float(answer @ residual) > SEEN**2

    def _answer(self, one: Evidence) -> Array:
        """(n,) what an explanation, or a pair of them, leaves in the other domain at its size."""
        names = one.hypothesis.name.split(JOIN)
        sizes = (
            np.split(np.array(one.coordinates), [one.joined]) if one.joined else [np.array(one.coordinates)]
        )
        found = np.zeros(len(self.space.residual))
        for name, size in zip(names, sizes, strict=True):
            if name in self.there:
                found += self.there[name].at(size * self.there[name].unit / self.own[name].unit)
        return found
