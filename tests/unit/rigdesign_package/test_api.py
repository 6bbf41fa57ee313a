"""The library as a user meets it: names, a short result, checks by id, saving."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import rigdesign
from rigdesign import api
from rigdesign.base import errors
from tests.builders.report import make_check, make_result


def test_the_package_lists_what_it_offers() -> None:
    assert dir(rigdesign) == sorted(rigdesign.__all__)
    assert {"load_case", "run_case", "save", "study", "compare", "diagnose", "predict"} <= set(dir(rigdesign))
    for name in rigdesign.__all__:
        assert getattr(rigdesign, name) is not None


def test_what_it_offers_is_what_the_modules_hold() -> None:
    assert rigdesign.run_case is api.run_case and rigdesign.study is api.study
    for name in ("CaseError", "NotConvergedError", "UsageError", "RigdesignError"):
        assert getattr(rigdesign, name) is getattr(errors, name)


def test_names_stay_functions_whatever_has_been_imported() -> None:
    """A folder of the package and a function must not have one name: the import of the one would hide the other."""
    code = (
        "import pkgutil, rigdesign\n"
        "folders = {module.name for module in pkgutil.iter_modules(rigdesign.__path__)}\n"
        "print(sorted(folders & set(rigdesign.__all__)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'run_cases'"):
        rigdesign.run_cases  # noqa: B018


def test_a_result_is_shown_in_a_line() -> None:
    """Printed whole it had 310,000 characters."""
    checks = [make_check("gap", 1.0, 0.3, comparison=">="), make_check("oil", 200.0, 150.0, unit="degC")]
    result = make_result(checks=checks, verdict="fail")
    assert (
        repr(result) == f"RunResult({result.case['name']}, {result.fidelity}: fail; 2 checks: 1 fail, 1 pass)"
    )
    page = result._repr_html_()
    assert page.count("<tr>") == 3 and "<td>oil</td><td>200</td><td>150</td><td>degC</td>" in page


def test_checks_by_id_and_by_number() -> None:
    result = make_result(
        checks=[make_check("gap", 1.0, 0.3, comparison=">="), make_check("oil_outlet", 1.0, 2.0)]
    )
    assert result.checks["oil_outlet"] is result.checks[1]
    assert [check.id for check in result.checks[:1]] == ["gap"]
    with pytest.raises(KeyError, match="no check 'oil_outlett'; the nearest are oil_outlet"):
        result.checks["oil_outlett"]


def test_a_data_frame_of_the_checks() -> None:
    pandas = pytest.importorskip("pandas")
    frame = make_result(checks=[make_check("gap", 1.0, 0.3), make_check("oil", 1.0, 2.0)]).to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.index) == ["gap", "oil"] and frame.loc["oil", "limit"] == 2.0


def test_without_pandas_the_remedy_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(rigdesign.MissingLibraryError, match="pip install pandas"):
        make_result().to_dataframe()


def test_a_result_is_saved_as_check_writes_it(tmp_path: Path) -> None:
    result = make_result()
    rigdesign.save(result, tmp_path / "out")
    stored = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert [check["id"] for check in stored["checks"]] == [check.id for check in result.checks]
    assert (tmp_path / "out" / "report.html").is_file() and (tmp_path / "out" / "junit.xml").is_file()


def test_a_shipped_case_is_found_by_its_name_from_anywhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert rigdesign.load_case("uhcf_prototype").path.parent.name == "uhcf_prototype"
    with pytest.raises(
        rigdesign.CaseError, match=r"name of a shipped case: fzg, loop_1to1, .*uhcf_prototype"
    ):
        rigdesign.load_case("uhcf_protoype")
    (tmp_path / "uhcf_prototype").mkdir()
    with pytest.raises(rigdesign.CaseError, match=r"no case\.toml in this folder"):
        rigdesign.load_case("uhcf_prototype")


def test_a_result_is_saved(tmp_path: Path) -> None:
    rigdesign.save(make_result(), tmp_path / "out")
    assert (tmp_path / "out" / "results.json").is_file()


def test_curves_are_arrays_by_quantity_and_unit(tmp_path: Path) -> None:
    """The same columns as in curves/*.csv."""
    result = make_result()
    ramp = result.curves["ramp"]
    assert isinstance(ramp["time [s]"], np.ndarray) and ramp["time [s]"].dtype == np.float64
    assert ramp["speed [rpm]"].shape == ramp["time [s]"].shape
    rigdesign.save(result, tmp_path / "out")
    files = {path.stem for path in (tmp_path / "out" / "curves").iterdir()}
    assert set(result.curves) == files - {"checks", "losses", "oil", "heat"}
    with (tmp_path / "out" / "curves" / "ramp.csv").open(encoding="utf-8") as stream:
        assert next(csv.reader(stream)) == list(ramp)


def test_a_call_limits_the_threads_of_numpy_and_gives_them_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a notebook numpy is the user's."""
    within = []

    def threads(*arguments: object, **keywords: object) -> object:
        within.append({library["num_threads"] for library in threadpool_info()})
        raise ZeroDivisionError

    for name in ("run_study", "compare_measurement", "diagnose_measurement"):
        monkeypatch.setattr(api, name, threads)
    with threadpool_limits(limits=2):
        for call in (
            lambda: api.study(None, (), ""),
            lambda: api.compare(None, ""),
            lambda: api.diagnose(None, ""),
        ):
            with pytest.raises(ZeroDivisionError):
                call()
        assert within == [{1}] * 3
        assert {library["num_threads"] for library in threadpool_info()} == {2}
