"""Comparisons, fits, diagnoses, sweeps and linear systems: the same answers as the commands."""
import json
import re

import loopwright as lw
import numpy as np
import pytest


def test_compare_answers_as_the_command(axis, program):
    expected = json.loads(program("compare", axis / "nominal.json", axis / "train.experiment.json", "--json", "-"))
    answer = lw.compare(axis / "nominal.json", axis / "train.experiment.json")
    assert answer.data.pop("plan") != expected.pop("plan")  # it names the build, and the module is another file
    assert answer.data == expected
    assert "position" in str(answer) and "<iframe" in answer._repr_html_()


def test_diagnose_finds_and_adds_the_effect(axis, tmp_path):
    diagram = lw.load(axis / "nominal.json")
    answer = lw.diagnose(diagram, axis / "train.experiment.json", improved=tmp_path / "better.json")
    assert answer["verdict"] == "explained"
    assert [effect["effect"] for effect in answer["effects"]] == ["viscous_friction"]
    better = answer.improved()
    before, after = (lw.compare(d, axis / "held_out.experiment.json")["force_residual"]["rmse"]
                     for d in (diagram, better))
    assert after < 0.7 * before
    answer.report(tmp_path / "page.html")
    assert "<html" in (tmp_path / "page.html").read_text()[:300]


def test_improved_says_what_is_missing(axis):
    with pytest.raises(ValueError, match="improved="):
        lw.diagnose(axis / "nominal.json", axis / "train.experiment.json").improved()


def test_linearize_gives_the_matrices_of_the_command(common_job, program):
    expected = json.loads(program("linearize", common_job, "--from", "stage.force", "--to", "stage.position", "--json", "-"))
    system = lw.load(common_job).linearize("stage.force", "stage.position")
    for name in "ABCD":
        assert np.array_equal(np.array(expected[name], dtype=float).reshape(getattr(system, name).shape),
                              getattr(system, name)), name
    assert system.dt == expected["sample_time"]
    assert max(abs(np.linalg.eigvals(system.A))) < 1


def test_sweep_has_the_table_of_the_command(common_job, program, tmp_path):
    file = tmp_path / "payload.sweep.json"
    file.write_text(json.dumps({
        "loopwright": 1, "diagram": str(common_job), "axes": {"stage.payload": {"values": [0, 0.1, 0.2]}},
        "metrics": {"tracking": {"rms": "error.sum"}}}))
    calls = []
    results = lw.sweep(file, tmp_path / "python", threads=2, progress=lambda done, total: calls.append(done))
    program("sweep", file, "-o", tmp_path / "command")
    expected = lw.read(tmp_path / "command" / "results.csv", allow_not_finite=True)
    assert results.missing == 0 and not results.failures
    assert np.array_equal(results["tracking"], expected["tracking"]) and len(results["tracking"]) == 3
    results.report(tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size > 1000


def test_fit_finds_a_parameter_as_the_command_does(axis, program):
    paths = [axis / "nominal.json", axis / "train.experiment.json"]
    expected = json.loads(program("fit", *paths, "--parameters", "axis.damping", "--json", "-"))
    found = lw.fit(*paths, ["axis.damping"])
    assert found.data == expected
    assert found.text == ""  # the value is in the file of the subdiagram


def test_fit_writes_the_page_of_the_command(axis, program, tmp_path):
    paths = [axis / "nominal.json", axis / "train.experiment.json"]
    program("fit", *paths, "--parameters", "axis.damping", "--report", tmp_path / "command.html")
    found = lw.fit(*paths, ["axis.damping"])
    found.report(tmp_path / "python.html")
    assert "<iframe" in found._repr_html_()

    def words(name):
        """Without what names the build and the day."""
        text = (tmp_path / name).read_text()
        return [part for part in re.findall(r">([^<>]+)<", text[text.index("<body"):]) if "axis.damping" in part]
    assert words("python.html") == words("command.html") != []


def test_fit_gives_the_text_of_the_fitted_diagram(common_job, tmp_path):
    lw.load(common_job, set={"stage.mass": 0.4}).run().save(tmp_path / "measured.csv")
    (tmp_path / "measured.experiment.json").write_text(json.dumps({
        "loopwright": 1, "data": "measured.csv", "time": "time", "drive": {},
        "compare": {"stage.position": {"column": "stage.position", "unit": "m"}}}))
    flat = tmp_path / "flat.json"
    flat.write_text(common_job.read_text().replace('"mass": "=mass"', '"mass": 0.2621'))
    found = lw.fit(flat, tmp_path / "measured.experiment.json", ["stage.mass"])
    assert found["parameters"]["stage.mass"]["value"] == pytest.approx(0.4, rel=1e-4)
    (tmp_path / "fitted.json").write_text(found.text)
    assert lw.compare(tmp_path / "fitted.json", tmp_path / "measured.experiment.json")["signals"]["stage.position"]["rmse"] < 1e-7
