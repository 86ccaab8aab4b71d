import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.study.design import points
from tcs_hil.hil.study.plan import Axis, Study

MASS = Axis(key="vehicle.body.mass_kg", low=1000.0, high=2000.0)
TEETH = Axis(key="sensors.teeth", low=44, high=47)
SCALING = Axis(key="road.0.scaling", values=("shape", "peak"))


def study(*axes, **options):
    return Study(scenario="manoeuvre-1", vary=axes, **options)


def test_a_latin_hypercube_has_one_point_in_every_slice_of_every_axis():
    chosen = points(study(MASS, SCALING, points=20))
    slices = sorted(int((mass - 1000.0) / 50.0) for mass, _ in chosen)
    assert slices == list(range(20))
    assert [scaling for _, scaling in chosen].count("peak") == 10


@pytest.mark.parametrize("design", ["latin-hypercube", "random"])
def test_the_seed_tells_the_points(design):
    first, again, other = (
        points(study(MASS, TEETH, design=design, points=5, seed=seed)) for seed in (1, 1, 2)
    )
    assert first == again != other


def test_a_grid_takes_every_combination():
    axis = Axis(key="vehicle.body.mass_kg", low=1000.0, high=2000.0, steps=3)
    chosen = points(study(axis, SCALING, design="grid"))
    assert chosen == [(m, s) for m in (1000.0, 1500.0, 2000.0) for s in ("shape", "peak")]


def test_whole_numbers_stay_whole_reach_both_ends_and_come_once_in_a_grid():
    drawn = {teeth for (teeth,) in points(study(TEETH, points=40))}
    assert drawn == {44, 45, 46, 47}
    assert points(study(TEETH, design="grid")) == [(44,), (45,), (46,), (47,)]


def test_a_grid_that_would_never_end_is_refused():
    axes = [Axis(key=f"k{i}", low=0.0, high=1.0, steps=1000) for i in range(3)]
    with pytest.raises(ConfigError, match="1000000000 points"):
        points(study(*axes, design="grid"))


@pytest.mark.parametrize(
    "axis", [{}, {"low": 1.0}, {"low": 2.0, "high": 1.0}, {"low": 1, "high": 2, "values": (1,)}]
)
def test_an_axis_has_either_a_range_or_values(axis):
    with pytest.raises(ValueError, match="`k`"):
        Axis(key="k", **axis)


def test_a_key_varies_once():
    with pytest.raises(ValueError, match="once"):
        study(MASS, MASS)
