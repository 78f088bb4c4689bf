"""The benchmark of denoising: what is kept is not measured again, and the goals are judged."""

import json

import numpy as np
import pytest
from benchmarks.denoising import best_filter, kept, main, measured
from benchmarks.denoising_report import Case, OddCase, goals, interval, told, written
from benchmarks.noisy_meshes import (
    CREASED,
    FURTHER,
    HELD_OUT,
    ODD,
    TUNED,
    errors,
    noisy,
    odd_noise,
)

import beltrami as bt
from benchmarks import denoising

LITTLE = {
    "clean": [1.0, 0.25],
    "said": [True, False, False],
    "levels": [
        {"level": 0.02, "noisy": 1.0, "distance": 0.75},
        {"level": 0.05, "noisy": 2.0, "distance": 2.4},
    ],
}


def facts(ours, peer, own=(1.0, 1.0), warned=False):
    theirs = {"noisy": (9.0, 0.3), "angle": [peer[0], "a"], "distance": [peer[1], "b"],
              "defaults": [9.0, 1.0]}  # fmt: skip
    return theirs, {"errors": ours, "own": own, "seconds": 1.0, "sigma": 0.1, "warned": warned}


def test_no_mesh_is_tuned_on_and_held_out():
    assert not set(TUNED) & set(HELD_OUT)
    assert set(CREASED) <= {*TUNED, *HELD_OUT}


def test_ratios_are_of_each_seed_and_their_interval_is_students():
    case = Case("blob", 0.2, 9, (facts((2, 0.3), (4, 0.5)), facts((3, 0.2), (4, 0.5))))
    assert case.ratios[:, :2].tolist() == pytest.approx(np.array([[0.5, 0.6], [0.75, 0.4]]))
    assert interval(case.ratios[:, 1]) == "0.50 ± 1.27"  # 12.71 * 0.1414 / 1.414
    assert interval([0.5]) == "0.50"


def test_goals_are_judged_for_each_group():
    assert told([0.6, 0.7, 0.81], (0.7, 0.8)) == (
        "median 0.700 (<= 0.70: met), worst 0.810 (<= 0.80: **missed**)"
    )
    blob = Case("blob", 0.2, 9, (facts((2, 0.3), (4, 0.5)),))
    can = Case("can", 0.2, 9, (facts((6, 0.45), (4, 0.5)),))
    odd = [OddCase("can", "strong", {"distance": 2.0, "linear": 1.0, "warned": False})]
    lines = goals([[blob], [can]], odd, []).splitlines()
    assert "0.600" in lines[2]
    assert "0.900 (<= 0.80: **missed**)" in lines[2]
    assert lines[3].endswith("not measured |")  # can is not organic
    white = next(line for line in lines if "another kind" in line)
    assert white.count("0 of 1 (0: met)") == 2
    alarm = Case("blob", 0.2, 9, (facts((2, 0.3), (4, 0.5), warned=True),))
    assert "1 of 1 (0: **missed**) | not measured" in goals([[alarm], []], odd, [])
    assert "said 0 of 1; median 2.000 (<= 1.00: **missed**)" in lines[-1]


def test_what_is_kept_is_not_measured_again(tmp_path, monkeypatch):
    assert kept(tmp_path, "one", lambda: {"a": 1}) == {"a": 1}
    assert kept(tmp_path, "one", lambda: {"a": 2}) == {"a": 1}
    assert kept(None, "one", lambda: {"a": 2}) == {"a": 2}
    assert json.loads((tmp_path / "one.json").read_text()) == {"a": 1}
    monkeypatch.setattr(denoising, "of_peers", lambda truth, mesh: facts((2, 1), (4, 2))[0])
    denoising.of_peers.__name__ = "of_peers"
    monkeypatch.setattr(denoising, "of_ours", lambda truth, mesh: facts((2, 1), (4, 2))[1])
    denoising.of_ours.__name__ = "of_ours"
    monkeypatch.setattr(denoising, "of_odd", lambda truth, mesh: {
        "noisy": 1.0, "distance": 0.2, "linear": 0.1, "warned": True})  # fmt: skip
    monkeypatch.setattr(denoising, "of_little", lambda truth: LITTLE)
    cases, odd, little = measured("ellipsoid", tmp_path, tmp_path, 2)
    assert little == {"ellipsoid": {**LITTLE, "peers": [[2, "b"], [2, "b"]]}}
    assert [len(case.runs) for case in cases] == [2, 2, 2]
    assert [one.kind for one in odd] == list(ODD)
    assert len(list(tmp_path.glob("ellipsoid-*.json"))) == 3 * 2 * 2 + 3 + 3
    target = tmp_path / "report.md"
    main(["ellipsoid", "no-such-mesh", "--folder", str(tmp_path), "--output", str(target)])
    text = target.read_text()
    assert "Not measured: no-such-mesh." in text
    assert "| ellipsoid | strong |" in text
    assert text.count("| ellipsoid 0.") == 3
    cases, odd, little = measured("ellipsoid", tmp_path, tmp_path, 3)
    assert text == written(cases, odd, ["no-such-mesh"], little=little)


def test_little_noise_is_a_section_of_its_own():
    """Of two cases one leaves more than there was, and both more than the best, once nothing."""
    little = {"one": {**LITTLE, "peers": [[0.5, "p"], [4.0, "q"]]}}
    text = written([], [], [], little=little)
    assert "| one | 0.2500 | 0.75 | 1.50 p | 1.20 | 1.20 nothing | 1 |" in text
    assert "median 0.97 of the noise, 1.35 of the best peer" in text
    assert "more than the noise: 1 of 2; more than the best peer: 2 of 2." in text
    assert "Little" not in written([], [], [])


def test_further_meshes_are_a_section_of_their_own(tmp_path, monkeypatch):
    monkeypatch.setattr(denoising, "of_peers", lambda truth, mesh: facts((2, 1), (4, 2))[0])
    denoising.of_peers.__name__ = "of_peers"
    monkeypatch.setattr(denoising, "of_ours", lambda truth, mesh: facts((2, 1.9), (4, 2))[1])
    denoising.of_ours.__name__ = "of_ours"
    monkeypatch.setattr(denoising, "of_little", lambda truth: LITTLE)
    bt.write_mesh(tmp_path / f"{FURTHER[-1]}.off", bt.shapes.icosphere(2))
    target = tmp_path / "report.md"
    folder = str(tmp_path)
    main(["no-such-mesh", "--further", folder, "--folder", folder, "--output", str(target)])
    text = target.read_text()
    assert text.count(f"| {FURTHER[-1]}.off 0.") == 3
    assert f"| {FURTHER[-1]}.off | 0.2500 |" in text
    assert f"{FURTHER[0]}.off" in text.split("Not measured: ")[1].split("\n")[0]
    section = text.split("## Further meshes")[1].split("## Noise of other")[0]
    assert "worst 0.950 (<= 0.80: **missed**)" in section
    assert "worst 0.500 (<= 1.10: met)" in section
    assert "Further" not in written([], [], [])


def test_errors_and_the_noise_that_makes_them():
    truth = bt.shapes.icosphere(3)
    edge = truth.edge_lengths.mean()
    assert errors(truth, truth.vertices * (1 + edge))[1] == pytest.approx(1, rel=1e-3)
    assert errors(truth, truth.vertices)[0] < 1e-4
    assert errors(truth, noisy(truth, 0.2, 0).vertices)[1] == pytest.approx(0.2, rel=0.1)
    levels = {kind: errors(truth, odd_noise(truth, kind, 0).vertices)[1] for kind in ODD}
    assert levels["impulses"] == pytest.approx(np.sqrt(0.1), rel=0.3)
    assert levels["strong"] == pytest.approx(0.7, rel=0.1)
    assert levels["correlated"] == pytest.approx(0.3, rel=0.1)
    linear, free = (best_filter(truth, noisy(truth, 0.2, 0), linear=one) for one in (True, False))
    assert free[0] <= linear[0] < 8
    assert free[1] <= linear[1] < 0.08
