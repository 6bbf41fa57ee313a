"""What `rigdesign calibrate` writes: calibration.json and the page, or the case with fitted constants."""

from pathlib import Path

from rigdesign.base.json_text import to_text
from rigdesign.base.output_folder import write_texts
from rigdesign.diagnosis.decision.patch import variant_text
from rigdesign.diagnosis.rig_calibration.document import calibration_document
from rigdesign.diagnosis.rig_calibration.healthy_sets import RigCalibration
from rigdesign.diagnosis.run import Calibrated
from rigdesign.report.pages.rig_calibration import rig_calibration_page


def write_rig_calibration(calibrated: RigCalibration, out: Path) -> None:
    """Write calibration.json and calibration.html, each whole or not at all.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    NonFiniteResultError
        If a number of the document is not finite; nothing is written then.
    """
    document = calibration_document(calibrated)
    page = rig_calibration_page(calibrated, document)
    write_texts(out, {"calibration.html": page, "calibration.json": to_text(document)})


def write_constants(calibrated: Calibrated, out: Path) -> None:
    """Write calibrated/case.toml, which extends the case, and constants.json with the covariance of the constants.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    """
    found = calibrated.constants
    document = {
        "case": {"name": calibrated.case.name, "hash": calibrated.case.hash},
        "measurement": {"title": calibrated.measurement.title, "hash": calibrated.measurement.hash},
        "constants": [
            {
                "effect": entry.effect.name,
                "parameter": entry.effect.parameters[0].name,
                "unit": entry.effect.parameters[0].unit,
                "value": entry.effect.parameters[0].value(entry.coordinate),
                "coordinate": "logarithm" if entry.effect.parameters[0].factor else "value",
                "deviation": entry.deviation,
                "deviation_before": entry.before,
            }
            for entry in found.entries
        ],
        "covariance": found.covariance.tolist(),
    }
    text = variant_text(calibrated.case, calibrated.title, calibrated.values, out / "calibrated")
    write_texts(out, {"calibrated/case.toml": text, "constants.json": to_text(document)})
