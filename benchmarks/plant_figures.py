"""The plant's verification as pictures: each against something that is not of its making."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.plant_runs import drive, plant
from plant_emulator.bustiming import BusTiming
from plant_emulator.compiled import records
from plant_emulator.tyre import Tyre, tyre_force
from plant_emulator.virtual_bus import Sender, VirtualBus
from tcs_hil.canbus.database import load_database

mpl.use("Agg")

MASS_KG, GRAVITY_MPS2, RADIUS_M = 1400.0, 9.81, 0.318
WHEEL_KGM2, MOTOR_KGM2, GEAR = 0.95, 0.03, 3.0
TRUTH: dict[str, Any] = {"color": "tab:blue", "linewidth": 1.6}
PEER: dict[str, Any] = {"color": "black", "linestyle": "--", "linewidth": 1.2}


def save_all(folder: Path, say: Callable[[str], object]) -> None:
    """Draw every picture into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in PICTURES.items():
        draw().savefig(folder / f"{name}.png", dpi=110)
        say(f"{folder / name}.png")


def quarter_car() -> Figure:
    """The quarter car and the paper's equations in SciPy's hands."""
    figure, (slip, error) = _canvas(2, "Quarter car against SciPy's DOP853, no control")
    rows = drive(
        plant(
            [(0.1, 0.0), (0.6, 250.0)],
            variant="quarter-car",
            road=[{"mu": 0.3}],
            start_speed_kmph=2.0,
        ),
        3.0,
    )
    time_s = rows["time_s"]
    speed, omega = _paper(time_s)
    rim = omega * RADIUS_M
    slip.plot(time_s, rows["slip_ratio"][:, 0], **TRUTH, label="plant")
    slip.plot(time_s, (rim - speed) * rim / (rim**2 + 0.1), **PEER, label="SciPy")
    slip.set(ylabel="slip ratio")
    slip.legend()
    error.semilogy(time_s, np.abs(rows["wheel_speed_radps"][:, 0] - omega) + 1e-16, **TRUTH)
    error.axhline(1e-9, **PEER)
    error.set(xlabel="time in s", ylabel="error of wheel speed in rad/s")
    return figure


def _paper(time_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Speed and wheel speed by the paper's equations, (2, instants), corner by corner."""

    def rates(t: float, x: NDArray[np.float64]) -> list[float]:
        rim = x[1] * RADIUS_M
        kappa = (rim - x[0]) * rim / (rim**2 + 0.1)
        load_n = MASS_KG * GRAVITY_MPS2 / 4
        force = 0.3 * load_n * 1.2005 * math.sin(1.401 * math.atan(17.1571 * kappa))
        torque = float(np.interp(t, [0.1, 0.6], [0.0, 250.0]))
        return [4 / MASS_KG * force, (GEAR * torque - force * RADIUS_M) / 1.22]

    state, start_s, pieces = np.array([2 / 3.6, 2 / 3.6 / RADIUS_M]), 0.0, []
    for end_s in (0.1, 0.6, float(time_s[-1]) + 1e-6):
        piece = solve_ivp(
            rates, (start_s, end_s), state, "DOP853", rtol=1e-13, atol=1e-13, dense_output=True
        )
        pieces.append(piece.sol(time_s[(time_s >= start_s) & (time_s < end_s)]))
        state, start_s = piece.y[:, -1], end_s
    return np.concatenate(pieces, axis=1)


def tyre_curves() -> Figure:
    """Two ways a slippery road bends the curve, and what load does to it."""
    figure, (roads, loads) = _canvas(2, "Default tyre: the paper's at its quarter load")
    kappa, tyre = np.linspace(0.0, 0.4, 401), records(Tyre())[0]
    for mu, colour in (
        (1.0, "tab:blue"),
        (0.6, "tab:green"),
        (0.3, "tab:orange"),
        (0.1, "tab:red"),
    ):
        for peak_only, style in ((False, "-"), (True, ":")):
            force = [tyre_force(tyre, k, 3433.5, mu, peak_only) for k in kappa]
            label = f"mu {mu}" + (", peak only" if peak_only else ", whole shape")
            roads.plot(kappa, np.array(force) * 1e-3, style, color=colour, label=label)
    roads.set(ylabel="force in kN at 3434 N")
    for load_n in (2000.0, 3433.5, 5000.0):
        force = [tyre_force(tyre, k, load_n, 1.0, False) / load_n for k in kappa]
        loads.plot(kappa, force, label=f"{load_n:.0f} N")
    loads.plot(kappa, 1.2005 * np.sin(1.401 * np.arctan(17.1571 * kappa)), **PEER, label="paper")
    loads.set(xlabel="slip ratio", ylabel="force / load")
    for axes in (roads, loads):
        axes.legend(fontsize=8, ncols=4, loc="lower right")
    roads.set_ylim(-1.2, 4.4)
    return figure


def half_shaft() -> Figure:
    """A torque step on wheels in the air: the shaft rings at sqrt(k / J)."""
    figure, (twist, spectrum) = _canvas(2, "Half-shaft on wheels without grip, step of 50 Nm")
    for damping, colour in ((1.0, "tab:blue"), (25.0, "tab:orange")):
        rows = drive(
            plant(
                [(0.0, 50.0)],
                driveline={"shaft_damping_nmsprad": damping, "motor_lag_s": 0.0},
                tyre={"qsy1": 0.0},
                road=[{"mu": 1e-9}],
                start_speed_kmph=50.0,
            ),
            0.5,
            5e-4,
        )
        wave = rows["shaft_twist_rad"][:, 0]
        label: dict[str, Any] = {"color": colour, "label": f"{damping:g} Nms/rad"}
        twist.plot(rows["time_s"], wave * 1e3, **label)
        bins = np.abs(np.fft.rfft(wave - wave[-200:].mean(), 2**15))
        spectrum.plot(np.fft.rfftfreq(2**15, 5e-4), bins / bins.max(), **label)
    inertia = 1.0 / (1.0 / WHEEL_KGM2 + 1.0 / (GEAR**2 * MOTOR_KGM2))
    spectrum.axvline(math.sqrt(6000.0 / inertia) / (2 * math.pi), **PEER, label="sqrt(k / J)")
    twist.set(xlabel="time in s", ylabel="twist in mrad")
    spectrum.set(xlabel="frequency in Hz", ylabel="spectrum", xlim=(5, 60))
    spectrum.legend()
    return figure


def steady_acceleration() -> Figure:
    """A steady push on a dry road against torque over all that moves, less resistance."""
    figure, (accel, error) = _canvas(2, "Steady acceleration on a dry road, from rest")
    spinning_kg = (4 * WHEEL_KGM2 + 2 * GEAR**2 * MOTOR_KGM2) / RADIUS_M**2
    for torque_nm in (50.0, 100.0, 150.0):
        rows = drive(plant([(0.0, torque_nm)]), 4.0)
        time_s = rows["time_s"]
        resisted_n = 0.01 * MASS_KG * GRAVITY_MPS2 + 0.39 * rows["speed_mps"] ** 2
        by_hand = (2 * GEAR * torque_nm / RADIUS_M - resisted_n) / (MASS_KG + spinning_kg)
        accel.plot(time_s, rows["accel_mps2"], label=f"{torque_nm:g} Nm per motor")
        accel.plot(time_s, by_hand, **PEER)
        settled = time_s > 1.5
        error.plot(time_s[settled], 100.0 * (rows["accel_mps2"] / by_hand - 1.0)[settled])
    accel.plot([], [], **PEER, label="by hand")
    accel.set(ylabel="acceleration in m/s2", ylim=(-0.1, 3.4))
    accel.legend(fontsize=8, loc="upper right")
    error.set(xlabel="time in s", ylabel="difference in %", xlim=accel.get_xlim())
    return figure


def load_transfer() -> Figure:
    """Load on the front axle against m a h / L while the driver plays with the throttle."""
    figure, (pitch, load) = _canvas(2, "Load transfer on a dry road")
    points = [(0.2, 0.0), (0.4, 150.0), (3.0, 150.0), (3.1, 40.0), (5.0, 40.0)]
    rows = drive(
        plant(points, tyre={"qsy1": 0.0}, body={"drag_area_m2": 0.0}, start_speed_kmph=20.0), 5.0
    )
    accel = rows["accel_mps2"]
    transfer_n = 2.0 * (rows["load_n"][0, 0] - rows["load_n"][:, 0])
    pitch.plot(rows["time_s"], np.degrees(rows["pitch_rad"]), **TRUTH)
    pitch.set(ylabel="pitch in degrees")
    load.plot(rows["time_s"], transfer_n, **TRUTH, label="plant")
    by_hand = (MASS_KG * accel * 0.526 + 4 * WHEEL_KGM2 * accel / RADIUS_M) / 2.62
    load.plot(rows["time_s"], by_hand, **PEER, label="(m a h + J domega/dt) / L")
    load.set(xlabel="time in s", ylabel="taken from the front axle in N")
    load.legend()
    return figure


def energy() -> Figure:
    """Where the motors' work goes, and how little is unaccounted for."""
    figure, (balance, rest) = _canvas(2, "Energy of a launch on mu 0.3, 250 Nm per motor")
    car = plant(
        [(0.0, 0.0), (0.5, 250.0)],
        road=[{"mu": 0.3}],
        body={"load_transfer": False},
        driveline={"shaft_stiffness_nmprad": 0.0},
        start_speed_kmph=20.0,
    )
    rows = drive(car, 2.0, 5e-4)
    speed, omega, motor = rows["speed_mps"], rows["wheel_speed_radps"], rows["motor_speed_radps"]
    rim = omega * RADIUS_M
    powers = {
        "motors' work": (rows["motor_torque_nm"] * motor).sum(axis=1),
        "tyre slip": (rows["force_n"] * (rim - speed[:, None])).sum(axis=1),
        "rolling resistance": (0.01 * rows["load_n"] * rim**2 / np.hypot(rim, 0.1)).sum(axis=1),
        "air": 0.39 * speed**3,
    }
    work = {name: _integral(rows["time_s"], power) for name, power in powers.items()}
    moving = 0.5 * MASS_KG * speed**2 + 0.5 * WHEEL_KGM2 * (omega**2).sum(axis=1)
    moving += 0.5 * MOTOR_KGM2 * (motor**2).sum(axis=1)
    work["kinetic energy gained"] = moving - moving[0]
    for name, joules in work.items():
        balance.plot(rows["time_s"], joules * 1e-3, label=name)
    balance.set(ylabel="energy in kJ")
    balance.legend(fontsize=8)
    taken = sum(joules for name, joules in work.items() if name != "motors' work")
    rest.plot(rows["time_s"], work["motors' work"] - taken, **TRUTH)
    rest.set(xlabel="time in s", ylabel="unaccounted for in J")
    return figure


def _integral(time_s: NDArray[np.float64], power_w: NDArray[np.float64]) -> NDArray[np.float64]:
    pieces = 0.5 * (power_w[1:] + power_w[:-1]) * np.diff(time_s)
    return np.concatenate([[0.0], np.cumsum(pieces)])


def convergence() -> Figure:
    """Error after a 50 ms push against the step size, from walking pace to top speed."""
    figure, (axes,) = _canvas(1, "Whole car, step of 80 Nm: error after 50 ms")
    steps = np.array([1e-4, 5e-5, 2.5e-5, 1.25e-5])

    def end(step_s: float, mu: float, speed_kmph: float) -> float:
        car = plant([(0.0, 80.0)], road=[{"mu": mu}], start_speed_kmph=speed_kmph)
        return float(drive(car, 0.05, step_s)["wheel_speed_radps"][-1, 0])

    for mu, speed_kmph in ((1.0, 2.0), (0.6, 36.0), (0.08, 200.0)):
        exact = end(6.25e-6, mu, speed_kmph)
        errors = np.array([abs(end(step, mu, speed_kmph) - exact) for step in steps])
        axes.loglog(steps * 1e3, errors, "o-", label=f"{speed_kmph:g} km/h, mu {mu:g}")
    axes.loglog(steps * 1e3, 1e-8 * (steps / steps[0]) ** 4, **PEER, label="fourth order")
    axes.axvline(0.1, color="tab:red", linewidth=1.0, label="step in use")
    axes.set(xlabel="step in ms", ylabel="error of wheel speed in rad/s")
    axes.set_xticks(steps * 1e3, [f"{step * 1e3:g}" for step in steps], minor=False)
    axes.minorticks_off()
    axes.legend(loc="lower right")
    return figure


def teeth() -> Figure:
    """What 48 teeth show of a launch from walking pace."""
    figure, (launch, fast) = _canvas(2, "48 teeth, both edges, 1 % pitch error")
    for axes, speed_kmph in ((launch, 2.0), (fast, 50.0)):
        car = plant([(0.1, 0.0), (0.6, 120.0)], road=[{"mu": 0.3}], start_speed_kmph=speed_kmph)
        shown, true, time_s = [], [], []
        while car.time_s < 0.6:
            shown.append(car.signals().wheel_speed_radps[0])
            true.append(car.truth.wheel_speed_radps[0])
            time_s.append(car.time_s)
            car.step(None, 0.002)
        axes.plot(time_s, shown, color="tab:orange", drawstyle="steps-post", label="sensor")
        axes.plot(time_s, true, **TRUTH, label="truth")
        axes.set(ylabel="front left in rad/s", title=f"from {speed_kmph:g} km/h")
        axes.legend()
    fast.set(xlabel="time in s")
    return figure


def bus_delay() -> Figure:
    """How long the cycle's frames take at 500 kbit/s, as strangers load the bus."""
    figure, (axes,) = _canvas(1, "From sampling to the last frame of the cycle, 500 kbit/s")
    names = ("DriverRequest", "MotorState", "WheelSpeedsFront", "WheelSpeedsRear")
    messages = [load_database().messages[name] for name in names]
    rng = np.random.default_rng(0)
    for load in (0.0, 0.2, 0.4):
        bus, last = VirtualBus(BusTiming(background_load=load)), messages[-1].frame_id
        for cycle in range(5000):
            for message in messages:
                data = rng.bytes(message.length)
                bus.offer(cycle * 2_000_000, message.frame_id, data, Sender.VEHICLE)
        arrived = [d for d in bus.run_until(12_000_000_000) if d.frame.frame_id == last]
        delay_ms = np.sort([(d.time_ns - i * 2_000_000) * 1e-6 for i, d in enumerate(arrived)])
        axes.plot(
            delay_ms, np.linspace(0.0, 1.0, delay_ms.size), label=f"load of strangers {load:.0%}"
        )
    axes.set(xlabel="delay in ms", ylabel="share of cycles", xlim=(0.5, 3.0))
    axes.legend()
    return figure


def _canvas(count: int, title: str) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(8.0, 3.0 + 1.5 * count), layout="constrained")
    figure.suptitle(title)
    axes = np.atleast_1d(figure.subplots(count, 1)).tolist()
    for each in axes:
        each.grid(alpha=0.3)
    return figure, axes


PICTURES: Mapping[str, Callable[[], Figure]] = {
    "quarter-car": quarter_car,
    "tyre-curves": tyre_curves,
    "half-shaft": half_shaft,
    "steady-acceleration": steady_acceleration,
    "load-transfer": load_transfer,
    "energy": energy,
    "convergence": convergence,
    "teeth": teeth,
    "bus-delay": bus_delay,
}
