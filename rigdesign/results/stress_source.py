"""Where the root stress per tooth force comes from."""

from typing import Literal

StressSource = Literal["finite-element influence numbers", "ISO 6336-3 form and stress correction factors"]
FROM_INFLUENCE: StressSource = "finite-element influence numbers"
FROM_FACTORS: StressSource = "ISO 6336-3 form and stress correction factors"
