# %% [markdown]
# # A rig from Python
# The cells run as a notebook (VS Code, Jupyter with jupytext) and as a script; what they write goes to `out`.

# %%
from pathlib import Path

import matplotlib.pyplot as plt

import rigdesign

case = rigdesign.load_case("loop_1to1")
result = rigdesign.run_case(case, fidelity="quick")
print(result)

# %% [markdown]
# ## What is near its limit

# %%
near = sorted(
    (check for check in result.checks if check.distance is not None),
    key=lambda check: check.distance or 0.0,
)
for check in near[:5]:
    print(f"{check.id:45} {check.value:8.4g} {check.unit:6} {100 * check.distance:4.0f} %  {check.status}")

# %% [markdown]
# ## The dynamic factor over speed
# Curves are arrays by name and `quantity [unit]`, the same columns as in `curves/*.csv`.

# %%
curve = result.curves["dynamic_factor_test"]
main = curve["torque"] == curve["torque"][0]
figure, axes = plt.subplots()
axes.plot(curve["speed [rpm]"][main], curve["max/mean [1]"][main], label="simulated")
axes.plot(curve["speed [rpm]"][main], curve["ISO 6336-1 method B [1]"][main], label="ISO 6336-1, method B")
axes.set_xlabel("speed of the pinion [rpm]")
axes.set_ylabel("dynamic factor K_V [-]")
axes.legend()
Path("out").mkdir(exist_ok=True)
figure.savefig("out/dynamic_factor.png")

# %% [markdown]
# ## What thinner oil does
# A changed case is a new case; the old one stays as it is. Bearings lose less in thinner oil, teeth more.

# %%
for inlet in ("40 degC", "80 degC"):
    changed = rigdesign.run_case(
        case.with_value("gearboxes.test.oil.inlet_temperature", inlet), fidelity="quick"
    )
    power: dict[str, float] = {}
    for row in changed.losses:
        if row.stage == "test":
            power[row.kind] = power.get(row.kind, 0.0) + row.power
    print(
        f"oil at {inlet}: {changed.verdict}; "
        + ", ".join(f"{kind} {watt:.0f} W" for kind, watt in power.items())
    )

# %% [markdown]
# ## A wrong value is an error that says what to do

# %%
try:
    case.with_value("gearboxes.test.oil.inlet_temperature", "140")
except rigdesign.CaseError as error:
    print(error)

# %%
rigdesign.save(result, "out")
