from benchmarks.ablation import effects
from plant_emulator.scenario import load_scenario

CARS = effects(load_scenario("manoeuvre-1"))


def test_the_car_with_everything_is_the_default_one() -> None:
    assert CARS["all"] == load_scenario("manoeuvre-1").with_variant("vehicle")


def test_every_effect_changes_the_bare_car_and_no_two_change_it_alike() -> None:
    cars = list(CARS.values())
    assert all(first != second for i, first in enumerate(cars) for second in cars[:i])


def test_all_effects_together_leave_nothing_of_the_bare_car() -> None:
    bare, full = CARS["none"], CARS["all"]
    switched_on = [car for name, car in CARS.items() if name not in {"none", "all"}]
    parts = [
        lambda car: car.vehicle.body,
        lambda car: car.vehicle.tyre,
        lambda car: car.vehicle.driveline.motor_lag_s,
        lambda car: car.vehicle.driveline.shaft_stiffness_nmprad,
        lambda car: car.sensors,
        lambda car: car.bus,
    ]
    for part in parts:
        assert part(bare) != part(full)
        assert [part(car) for car in switched_on].count(part(full)) == 1
