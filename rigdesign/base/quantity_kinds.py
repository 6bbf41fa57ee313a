"""Kinds of quantity a case file knows: the unit inside, the units accepted, the unit shown."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

ZERO_CELSIUS = 273.15
"""0 degC [K]."""


@dataclass(frozen=True)
class QuantityKind:
    """A kind of quantity.

    si : unit inside, in pint's words
    units : spelling in the case file -> unit in pint's words; the first is the one used for display
    example : a quantity of this kind as a user writes it
    """

    name: str
    si: str
    units: Mapping[str, str]
    example: str

    @property
    def display_unit(self) -> str:
        """Unit of tables and axes."""
        return next(iter(self.units))

    @property
    def remedy(self) -> str:
        """What to write: the accepted units and an example."""
        return f'write a {self.label} such as "{self.example}" (units: {", ".join(self.units)})'

    def like(self, example: str) -> "QuantityKind":
        """The kind with another example, whose unit then comes first: hints for the size of what is meant."""
        unit = example.partition(" ")[2]
        return replace(self, example=example, units={unit: self.units[unit], **self.units})

    @property
    def label(self) -> str:
        """Name in a sentence."""
        return self.name.replace("_", " ")


def _kinds(*kinds: QuantityKind) -> dict[str, QuantityKind]:
    return {kind.name: kind for kind in kinds}


KINDS: Mapping[str, QuantityKind] = _kinds(
    QuantityKind("length", "m", {"mm": "mm", "um": "um", "cm": "cm", "m": "m", "in": "inch"}, "7 mm"),
    QuantityKind("angle", "rad", {"deg": "degree", "rad": "radian", "mrad": "milliradian"}, "20 deg"),
    QuantityKind("volume", "m**3", {"l": "liter", "ml": "milliliter", "m3": "m**3"}, "1.5 l"),
    QuantityKind("mass", "kg", {"kg": "kg", "g": "g"}, "4 kg"),
    QuantityKind(
        "inertia", "kg*m**2", {"kg m2": "kg*m**2", "kg cm2": "kg*cm**2", "g m2": "g*m**2"}, "0.01 kg m2"
    ),
    QuantityKind(
        "unbalance", "kg*m", {"g mm": "g*mm", "kg mm": "kg*mm", "g m": "g*m", "kg m": "kg*m"}, "50 g mm"
    ),
    QuantityKind("temperature", "kelvin", {"degC": "degC", "K": "kelvin", "degF": "degF"}, "140 degC"),
    QuantityKind("temperature_difference", "kelvin", {"K": "kelvin"}, "20 K"),
    QuantityKind(
        "warming_rate",
        "kelvin/second",
        {"K/h": "kelvin/hour", "K/min": "kelvin/minute", "K/s": "kelvin/second"},
        "2 K/h",
    ),
    QuantityKind("time", "s", {"s": "s", "ms": "ms", "min": "minute", "h": "hour", "d": "day"}, "8 s"),
    QuantityKind(
        "recording_time",
        "s",
        {"s": "s", "ms": "ms", "us": "us", "ns": "ns", "min": "minute", "h": "hour", "d": "day"},
        "1 ms",
    ),
    QuantityKind("frequency", "hertz", {"Hz": "hertz", "kHz": "kilohertz"}, "40 kHz"),
    QuantityKind(
        "speed",
        "rad/s",
        {"rpm": "revolution/minute", "1/min": "revolution/minute", "rad/s": "rad/s"},
        "12000 rpm",
    ),
    QuantityKind("velocity", "m/s", {"m/s": "m/s", "km/h": "km/hour"}, "20 m/s"),
    QuantityKind("acceleration", "m/s**2", {"m/s2": "m/s**2", "g": "g_0"}, "2 m/s2"),
    QuantityKind("force", "N", {"N": "N", "kN": "kN"}, "450 N"),
    QuantityKind(
        "torque", "N*m", {"N m": "N*m", "Nm": "N*m", "kN m": "kN*m", "kNm": "kN*m", "N mm": "N*mm"}, "180 N m"
    ),
    QuantityKind("power", "W", {"W": "W", "kW": "kW", "MW": "MW"}, "500 W"),
    QuantityKind(
        "pressure",
        "Pa",
        {"MPa": "MPa", "N/mm2": "MPa", "Pa": "Pa", "kPa": "kPa", "GPa": "GPa", "bar": "bar"},
        "206 GPa",
    ),
    QuantityKind(
        "flow",
        "m**3/s",
        {
            "l/min": "liter/minute",
            "l/h": "liter/hour",
            "l/s": "liter/s",
            "ml/min": "ml/minute",
            "m3/h": "m**3/hour",
            "m3/s": "m**3/s",
        },
        "5 l/min",
    ),
    QuantityKind(
        "density", "kg/m**3", {"kg/m3": "kg/m**3", "g/cm3": "g/cm**3", "kg/l": "kg/liter"}, "1000 kg/m3"
    ),
    QuantityKind(
        "kinematic_viscosity",
        "m**2/s",
        {"mm2/s": "mm**2/s", "cSt": "mm**2/s", "m2/s": "m**2/s"},
        "27.6 mm2/s",
    ),
    QuantityKind(
        "dynamic_viscosity",
        "Pa*s",
        {"mPa s": "mPa*s", "Pa s": "Pa*s", "cP": "mPa*s"},
        "5 mPa s",
    ),
    QuantityKind(
        "heat_capacity",
        "J/(kg*K)",
        {"J/(kg K)": "J/(kg*K)", "J/kgK": "J/(kg*K)", "kJ/(kg K)": "kJ/(kg*K)", "kJ/kgK": "kJ/(kg*K)"},
        "2000 J/(kg K)",
    ),
    QuantityKind(
        "pressure_viscosity",
        "1/Pa",
        {"1/GPa": "1/GPa", "mm2/N": "mm**2/N", "m2/N": "m**2/N", "1/Pa": "1/Pa"},
        "18 1/GPa",
    ),
    QuantityKind("conductance", "W/K", {"W/K": "W/K", "kW/K": "kW/K"}, "20 W/K"),
    QuantityKind("body_heat_capacity", "J/K", {"J/K": "J/K", "kJ/K": "kJ/K"}, "20 kJ/K"),
    QuantityKind("conductivity", "W/(m*K)", {"W/(m K)": "W/(m*K)", "W/mK": "W/(m*K)"}, "45 W/(m K)"),
    QuantityKind(
        "heat_transfer_coefficient",
        "W/(m**2*K)",
        {"W/(m2 K)": "W/(m**2*K)", "W/m2K": "W/(m**2*K)"},
        "300 W/(m2 K)",
    ),
    QuantityKind(
        "torsional_stiffness",
        "N*m/rad",
        {"N m/rad": "N*m/rad", "Nm/rad": "N*m/rad", "kN m/rad": "kN*m/rad"},
        "290e3 N m/rad",
    ),
    QuantityKind(
        "torsional_damping", "N*m*s/rad", {"N m s/rad": "N*m*s/rad", "Nms/rad": "N*m*s/rad"}, "600 N m s/rad"
    ),
    QuantityKind("linear_stiffness", "N/m", {"N/m": "N/m", "N/um": "N/um", "kN/mm": "kN/mm"}, "1e8 N/m"),
    QuantityKind(
        "linear_damping", "N*s/m", {"N s/m": "N*s/m", "Ns/m": "N*s/m", "kN s/m": "kN*s/m"}, "1000 N s/m"
    ),
    QuantityKind("data_size", "byte", {"MB": "megabyte", "GB": "gigabyte", "kB": "kilobyte"}, "500 MB"),
    QuantityKind("voltage", "V", {"V": "V", "mV": "mV", "uV": "uV"}, "5 V"),
    QuantityKind("resistance", "ohm", {"ohm": "ohm", "mohm": "milliohm", "kohm": "kiloohm"}, "120 ohm"),
    QuantityKind("voltage_ratio", "V/V", {"mV/V": "mV/V", "uV/V": "uV/V", "V/V": "V/V"}, "2 mV/V"),
    QuantityKind("strain", "m/m", {"um/m": "um/m", "mm/m": "mm/m", "m/m": "m/m"}, "500 um/m"),
    QuantityKind("expansion_coefficient", "1/K", {"1/K": "1/K", "um/(m K)": "um/(m*K)"}, "11.5e-6 1/K"),
)
"""Every kind of quantity a case file knows, by name."""
