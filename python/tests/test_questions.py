"""Models, Campbell tables, shards, rows solved again, estimates, figures, single wheels: what the commands give."""

import json
import math
import pickle
import shutil
from pathlib import Path

import matplotlib
import numpy
import pytest
from conftest import SMALL, called, is_that_of

import blisk

matplotlib.use("Agg")


def exact_hz(diameter, contact_stiffness, own=SMALL["model"]["lumped"]):
    """Frequencies of blade, disk and ring with a phase from sector to sector: three masses, by NumPy."""
    wave = 2 - 2 * math.cos(2 * math.pi * diameter / own["sectors"])
    blade, joint = own["blade_stiffness_n_per_m"], own["ring_disk_stiffness_n_per_m"] + contact_stiffness
    disk = own["disk_ground_stiffness_n_per_m"] + wave * own["disk_coupling_stiffness_n_per_m"]
    ring = wave * own["ring_coupling_stiffness_n_per_m"]
    stiffness = numpy.array([[blade, -blade, 0], [-blade, blade + disk + joint, -joint], [0, -joint, joint + ring]])
    mass = numpy.array([own["blade_mass_kg"], own["disk_mass_kg"], own["ring_mass_kg"]])
    squares = numpy.linalg.eigvalsh(stiffness / numpy.sqrt(numpy.outer(mass, mass)))
    return numpy.sqrt(squares) / (2 * math.pi)


def test_frequencies_of_the_tuned_wheel_are_those_of_three_masses(study):
    rows = blisk.modes(study, 3)
    assert {row["contact"] for row in rows} >= {"slide", "stuck"}
    for row in rows:
        springs = SMALL["contact"]["tangential_stiffness_n_per_m"] if row["contact"] == "stuck" else 0.0
        expected = exact_hz(row["nodal_diameter"], springs)[row["mode"] - 1]
        assert math.isclose(row["frequency_hz"], expected, rel_tol=1e-9), row
    assert len([row for row in rows if row["contact"] == "stuck"]) == 4 * 3


def test_a_campbell_table_is_that_of_the_command(study):
    answer = blisk.campbell(study, [1, 2, 3], (0, 12000), modes=2)
    is_that_of(answer, "campbell", "study.toml", "--engine-orders", "1:3", "--speed-rpm", "0:12000", "--modes", 2)
    assert blisk.campbell(study, [1, 2, 3], plot="speed.svg", plot_safe="safe.svg", top_hz=5000) is not None
    assert "Campbell diagram" in Path("speed.svg").read_text() and "Ends at 5000 Hz" in Path("safe.svg").read_text()
    with pytest.raises(ValueError, match=r"\.svg"):
        blisk.campbell(study, plot="speed.png")
    crossing = answer["crossings"][0]
    springs = {"stuck": SMALL["contact"]["tangential_stiffness_n_per_m"]}.get(crossing["contact"], 0.0)
    hz = exact_hz(crossing["nodal_diameter"], springs)[crossing["mode"] - 1]
    assert math.isclose(crossing["speed_rpm"], 60 * hz / crossing["engine_order"], rel_tol=1e-9)
    for more in ({"modes": 0}, {"engine_orders": [0]}, {"speed_rpm": (2, 1)}, {"at": {-1.0: "bundle"}}):
        with pytest.raises(ValueError, match="accepted"):
            blisk.campbell(study, **more)


def test_a_model_is_that_of_the_command_and_is_exported(study):
    answer = blisk.model(study, export="bundle")
    is_that_of(answer, "model", "study.toml")
    assert answer._repr_html_().startswith("<pre>")
    sector = blisk.Sector.from_bundle("bundle")
    assert (sector.sectors, sector.model["source"]) == (6, "bundle")
    assert numpy.allclose(sector.frequencies_hz(3)[2], exact_hz(2, 0.0), rtol=1e-9)
    at = blisk.campbell(study, at={0.0: "bundle", 6000.0: "bundle"})
    is_that_of(at, "campbell", "study.toml", "--at", "0=bundle", "--at", "6000=bundle")


def test_shards_are_joined(study, finished):
    for number in (1, 2):
        ended = called("run", "study.toml", "--out", "out", "--shard", f"{number}/2")
        assert ended.returncode == 0, ended.stderr
    results = blisk.merge("out", out="merged")
    for name in ("responses", "scenarios", "percentiles"):
        assert (results.folder / f"{name}.parquet").read_bytes() == (finished.folder / f"{name}.parquet").read_bytes()
    with pytest.raises(blisk.BliskError) as refused:
        blisk.merge("elsewhere", out="other")
    assert refused.value.exit_code in (2, 7)
    with pytest.raises(TypeError):
        blisk.merge(out="other")


def test_a_row_solved_again_is_the_same(finished):
    answer = blisk.replay(finished, 1, 3)
    assert answer["identical"]
    is_that_of(answer, "replay", finished.folder, "--scenario", 1, "--pattern", 3)
    full = blisk.replay(finished, 1, 3, fidelity="full")
    is_that_of(full, "replay", finished.folder, "--scenario", 1, "--pattern", 3, "--fidelity", "full")
    # The model is small: its reduced model is all of it, and harmonics are what differs.
    assert abs(full["full"]["amplitude_error"]) < 0.01
    with pytest.raises(blisk.BliskError, match="there is no"):
        blisk.replay(finished, 99, 3)
    with pytest.raises(ValueError, match="reduced, full"):
        blisk.replay(finished, 1, 3, fidelity="best")


@pytest.mark.parametrize(
    ("question", "flags"), [("full_model", []), ("dense_sweep", ["--dense-sweep"]), ("time_domain", ["--time-domain"])]
)
def test_a_sample_solved_again_is_that_of_the_command(study, question, flags):
    results = blisk.run(study.replace({"study.patterns": 6}), out="out")
    stages = []
    answer = blisk.verify(results, question, sample=2, seed=5, progress=stages.append)
    assert answer["verified"]
    is_that_of(answer, "verify", "out", "--sample", 2, "--seed", 5, *flags)
    assert stages


def test_files_are_looked_at(study):
    results = blisk.run(study.replace({"study.patterns": 3}), out="out")
    assert blisk.verify(results, "integrity")["whole"]
    is_that_of(blisk.verify(results, "integrity"), "verify", "out", "--integrity")
    path = results.folder / "scenarios.parquet"
    path.write_bytes(path.read_bytes()[:-1])
    answer = blisk.verify(results, "integrity")
    assert not answer["whole"] and "scenarios.parquet" in str(answer)
    is_that_of(answer, "verify", "out", "--integrity", code=8)
    with pytest.raises(ValueError, match="full_model, dense_sweep"):
        blisk.verify(results, "luck")
    with pytest.raises(ValueError, match="time_domain"):
        blisk.verify(results, row=(0, 0))


def damaged(folder, *names):
    """The folder with files that have lost their last byte."""
    for name in names:
        path = folder / name
        path.write_bytes(path.read_bytes()[:-1])
    return folder


@pytest.mark.parametrize("names", [[], ["responses.parquet"], ["scenarios.parquet", "manifest.json"]])
def test_a_repair_is_that_of_the_command(study, tmp_path, names):
    results = blisk.run(study.replace({"study.patterns": 6}), out="first", threads=1)
    whole = {path.name: path.read_bytes() for path in results.folder.glob("*.parquet")}
    # The command and the function name the folder, which therefore has to be the same one.
    given = {}
    (tmp_path / "study.toml").write_text(study.replace({"study.patterns": 6}).to_toml())
    for way in ("own", "words", "json"):
        shutil.rmtree("out", ignore_errors=True)
        folder = damaged(shutil.copytree("first", tmp_path / "out"), *names)
        if way == "own":
            given[way] = blisk.verify("out", "integrity", repair=True, study_file="study.toml", threads=1)
            assert {path.name: path.read_bytes() for path in folder.glob("*.parquet")} == whole
            assert blisk.verify("out", "integrity")["whole"]
        else:
            flags = ["--json"] if way == "json" else []
            ended = called("verify", "out", "--repair", "--study", "study.toml", "--threads", 1, *flags)
            assert ended.returncode == 0, ended.stderr
            given[way] = ended.stdout
    assert given["own"] == json.loads(given["json"])
    assert str(given["own"]) + "\n" == given["words"]
    assert len(given["own"]["set_aside"]) == len(names)
    with pytest.raises(ValueError, match="repair is that of question = 'integrity'"):
        blisk.verify(results, repair=True)


def test_how_far_a_folder_is_is_that_of_the_command(study, finished):
    is_that_of(blisk.status(finished), "status", finished.folder)
    assert blisk.status(finished.folder)["planned"] == 320
    ended = called("run", "study.toml", "--out", "out", "--shard", "1/2")
    assert ended.returncode == 0, ended.stderr
    answer = blisk.status("out")
    is_that_of(answer, "status", "out")
    assert answer["missing_shards"] == [2] == [int(called("status", "out", "--missing").stdout)]
    with pytest.raises(blisk.BliskError) as refused:
        blisk.status("nothing")
    assert refused.value.exit_code == called("status", "nothing").returncode


def test_fitted_tails_are_those_of_the_command(study):
    results = blisk.run(study, out="out", threads=2)
    answer = blisk.tails(results)
    written = (results.folder / "tail_fits.parquet").read_bytes()
    is_that_of(answer, "stats", "out", "--tails")
    assert (results.folder / "tail_fits.parquet").read_bytes() == written
    assert len(answer["tails"]) == 4 * 2 and len(results.table("tail_fits")) > 0


def test_an_estimate_is_that_of_the_command(study):
    own = {"patterns": 400, "solves": 80, "threads": 2}
    answer = blisk.estimate(study, 95, out="own", **own)
    is_that_of(answer, "estimate", "study.toml", "--target", 95, "--patterns", 400, "--solves", 80, "--out", "other")
    for target in ("median", 10.0, 100.0):
        with pytest.raises(ValueError, match="mean, or a percentile"):
            blisk.estimate(study, target, out="own")
    with pytest.raises(ValueError, match="solves = 0"):
        blisk.estimate(study, solves=0)


def test_what_accuracy_costs_is_measured(study):
    answer = blisk.tradeoff(study, 2, out="own", threads=1)
    ended = called("tradeoff", "study.toml", "--patterns", 2, "--out", "other", "--threads", 1, "--json")
    assert ended.returncode == 0, ended.stderr
    other = json.loads(ended.stdout)
    assert answer.keys() == other.keys() and str(answer)
    # Times differ; the errors do not.
    assert errors_in(answer) == errors_in(other) != []
    with pytest.raises(ValueError, match="at least 2"):
        blisk.tradeoff(study, 1)
    with pytest.raises(ValueError, match="reduced, full"):
        blisk.tradeoff(study, reference="none")


def errors_in(value):
    """All numbers under a key that names an error, in order."""
    if isinstance(value, dict):
        return [own for key, inner in value.items() for own in ([inner] if "error" in key else errors_in(inner))]
    return [own for inner in value for own in errors_in(inner)] if isinstance(value, list) else []


def test_figures_are_those_of_the_command(finished, tmp_path):
    names = blisk.figures()
    assert "amplitude" in names and all(names.values())
    for name in ("amplitude", "amplitude-distribution", "worst-response"):
        figure = finished.figure(name)
        ended = called("plot", finished.folder, name, "--out", tmp_path / "other.svg")
        assert ended.returncode == 0, ended.stderr
        assert figure.save(tmp_path / "own.svg").read_bytes() == (tmp_path / "other.svg").read_bytes()
        assert figure._repr_svg_() == figure.svg and figure.title in ended.stdout
    with pytest.raises(ValueError, match="accepted: amplitude"):
        finished.figure("nothing")
    with pytest.raises(ValueError, match="nothing to draw"):
        finished.figure("accuracy")
    page = finished._repr_html_()
    assert "<svg" in page and "P95" in page


def test_axes_hold_the_numbers_of_the_tables(finished):
    axes = finished.plot(percentiles=[50, 95, 99])
    lines = {line.get_label(): line for line in axes.get_lines()}
    rows = [row for row in finished.scenarios.rows() if row["contact"] == "full"]
    # 80 wheels have no P99.
    assert {"P50", "P95", "tuned"} <= set(lines) and "P99" not in lines
    # In the unit and the scale of the figure of the report: stuck and slide are several times higher than the best load.
    assert list(lines["P95"].get_ydata()) == [row["peak_amplitude_m_p95"] / 1e-6 for row in rows]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    figure = finished.figure().svg
    assert axes.get_ylabel() == "peak blade amplitude, µm (log.)" and axes.get_ylabel() in figure
    assert axes.get_xlabel() == "damper normal load per sector, N (logarithmic)" and axes.get_xlabel() in figure
    assert {"slide", "stuck"} <= set(lines)
    assert list(lines["P95"].get_xdata()) == [row["normal_load_n"] for row in rows] == [50, 150]
    assert list(lines["tuned"].get_ydata()) == [row["tuned_amplitude_m"] / 1e-6 for row in rows]
    again = finished.plot("amplification_factor", ax=axes)
    assert again is axes and axes.get_ylabel() == "amplification factor"
    assert axes.get_yscale() == "linear" and axes.get_ylabel() in finished.figure("amplification-factor").svg
    with pytest.raises(ValueError, match="accepted: peak_amplitude_m"):
        finished.plot("luck")
    with pytest.raises(ValueError, match="no scenario"):
        finished.plot(engine_order=9)
    matplotlib.pyplot.close("all")


def test_axes_of_a_distribution_hold_the_numbers_of_the_table(finished):
    def stairs(axes):
        return {line.get_label(): line for line in axes.get_lines() if not line.get_label().startswith("_")}

    best = finished.best(percentile=95)
    axes = finished.plot_distribution()
    (name,) = stairs(axes)
    assert name == f"{best.normal_load_n:g} N"
    table = finished.distribution.rows()
    rows = [row for row in table if row["scenario"] == best.scenario and row["quantity"] == "peak_amplitude_m"]
    line = stairs(axes)[name]
    assert len(rows) == 80 and list(line.get_xdata()) == [row["value"] / 1e-6 for row in rows]
    assert list(line.get_ydata()) == [100 * row["cumulative"] for row in rows]
    # Titles, unit and scale of the figure of the report: the median of Gumbel's law is 0.3665 of its reduced variate.
    figure = finished.figure("amplitude-distribution").svg
    assert axes.get_xlabel() == "peak blade amplitude, µm" and axes.get_xlabel() in figure
    assert axes.get_ylabel() == "wheels below, % (Gumbel scale)" and axes.get_ylabel() in figure
    assert axes.get_xscale() == "linear" and axes.get_ylim() == (0.625, 99.9)
    to_scale = axes.yaxis.get_transform()
    assert to_scale.transform([50.0]) == pytest.approx([0.36651], abs=1e-5)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["1", "5", "25", "50", "75", "95", "99", "99.9"]
    # The square of the P95 lies on the stair, with its bounds.
    points = [(list(own.get_xdata()), list(own.get_ydata())) for own in axes.get_lines()]
    assert ([best.value / 1e-6], [95.0]) in points
    assert ([best.lower / 1e-6, best.upper / 1e-6], [95.0, 95.0]) in points
    # Other loads, another quantity, axes of one's own for a paper.
    _, own = matplotlib.pyplot.subplots(figsize=(3.35, 2.7), layout="constrained")
    assert finished.plot_distribution("amplification_factor", loads=["slide", 150, "stuck"], ax=own) is own
    assert list(stairs(own)) == ["slide", "150 N", "stuck"] and own.get_xlabel() == "amplification factor"
    own.figure.draw_without_rendering()
    with pytest.raises(ValueError, match=r"loads = \[70\] is not accepted; accepted: some of 'slide', 50, 150, 'stuck'"):
        finished.plot_distribution(loads=[70])
    with pytest.raises(ValueError, match="accepted: peak_amplitude_m"):
        finished.plot_distribution("luck")
    matplotlib.pyplot.close("all")


def test_labels_of_loads_do_not_run_into_each_other(study):
    loads = [50, 80, 100, 120, 140, 150, 400, 1000]
    results = blisk.run(study.replace({"study.patterns": 6, "sweep.normal_load_n": loads}))
    _, axes = matplotlib.pyplot.subplots(figsize=(3.5, 2.8), layout="constrained")
    results.plot(percentiles=[50], ax=axes)
    axes.figure.draw_without_rendering()
    ticks = [label for label in axes.get_xticklabels() if label.get_text()]
    boxes = [label.get_window_extent() for label in ticks]
    assert all(left.x1 < right.x0 for left, right in zip(boxes, boxes[1:]))
    texts = [label.get_text() for label in ticks]
    # Every load has a tick, and the ends have labels. Where there is room all loads have one.
    assert list(axes.get_xticks()) == loads
    assert 4 <= len(texts) < len(loads) and (texts[0], texts[-1]) == ("50", "1000") and set(texts) < set(map(str, loads))
    _, wide = matplotlib.pyplot.subplots(figsize=(30, 3))
    results.plot(percentiles=[50], ax=wide)
    assert [label.get_text() for label in wide.get_xticklabels()] == list(map(str, loads))
    matplotlib.pyplot.close("all")


DEVIATIONS = [0.02, -0.01, 0.005, -0.03, 0.01, 0.0]


def test_one_wheel_has_the_peaks_of_its_pattern_file(study, tmp_path):
    wheel = study.wheel(DEVIATIONS)
    peaks = wheel.peaks(threads=1)
    lines = "".join(f"0,{blade},{deviation}\n" for blade, deviation in enumerate(DEVIATIONS))
    (tmp_path / "wheel.csv").write_text("pattern,blade,deviation\n" + lines)
    own = study.to_dict()
    own["mistuning"] = {"file": "wheel.csv"}
    del own["sweep"]["standard_deviation"], own["study"]["patterns"]
    (tmp_path / "wheel.toml").write_text(blisk.Study(**own).to_toml())
    ended = called("run", "wheel.toml", "--out", "wheel")
    assert ended.returncode in (0, 5), ended.stderr
    rows = blisk.Results("wheel").responses.rows()
    assert [peak.amplitude_m for peak in peaks] == [row["peak_amplitude_m"] for row in rows]
    assert [peak.normal_load_n for peak in peaks] == [None, 50, 150, None]
    assert wheel.peak(50) == peaks[1] and pickle.loads(pickle.dumps(peaks)) == peaks
    curve = wheel.response(50, [peaks[1].frequency_hz])
    assert math.isclose(max(curve["amplitude_m"]), peaks[1].amplitude_m, rel_tol=1e-4)


def test_one_wheel_at_the_linear_limit_is_masses_and_springs(study):
    own, sectors = SMALL["model"]["lumped"], 6
    stiffness, mass = numpy.zeros((18, 18)), numpy.zeros(18)
    for n in range(sectors):
        blade, disk, ring = n, sectors + n, 2 * sectors + n
        mass[[blade, disk, ring]] = own["blade_mass_kg"], own["disk_mass_kg"], own["ring_mass_kg"]
        stiffness[disk, disk] += own["disk_ground_stiffness_n_per_m"]
        for a, b, k in (
            (blade, disk, own["blade_stiffness_n_per_m"] * (1 + DEVIATIONS[n])),
            (disk, sectors + (n + 1) % sectors, own["disk_coupling_stiffness_n_per_m"]),
            (ring, 2 * sectors + (n + 1) % sectors, own["ring_coupling_stiffness_n_per_m"]),
            (ring, disk, own["ring_disk_stiffness_n_per_m"]),
        ):
            stiffness[[a, b], [a, b]] += k
            stiffness[[a, b], [b, a]] -= k
    peak = study.wheel(DEVIATIONS).peak("slide")
    force = numpy.zeros(18, complex)
    force[:sectors] = 10.0 * numpy.exp(2j * math.pi * 2 * numpy.arange(sectors) / sectors)
    omega = 2 * math.pi * peak.frequency_hz
    solved = numpy.linalg.solve(stiffness * (1 + 0.002j) - omega**2 * numpy.diag(mass), force)
    amplitude = abs(solved)[:sectors]
    assert amplitude.argmax() == peak.blade
    assert math.isclose(amplitude.max(), peak.amplitude_m, rel_tol=1e-6)


def test_blades_far_from_those_of_the_model_are_remarked_on(study):
    with pytest.warns(UserWarning, match=r"mean deviation of blade stiffness is -59 %"):
        study.wheel([-0.6] * 5 + [-0.54])


def test_a_wheel_that_is_not_accepted_is_refused(study):
    for deviations in ([], [-1.0], [float("nan")]):
        with pytest.raises(ValueError, match="a number above -1"):
            study.wheel(deviations)
    with pytest.raises(blisk.BliskError):
        study.wheel([0.0] * 5).peak(50)
    with pytest.raises(ValueError, match="several load cases or engine orders"):
        study.replace({"excitation.engine_orders": [1, 2]}).wheel(DEVIATIONS).peak(50)
