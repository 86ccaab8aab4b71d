"""`[[expect]]` made ready to be measured: every name found or refused before anything runs."""

from __future__ import annotations

import math
from collections.abc import Set
from difflib import get_close_matches

from plant_emulator.expect import Expect
from tcs_hil.errors import ConfigError, offer
from tcs_hil.hil.judging.channels import Channel, Namespace, namespace, number
from tcs_hil.hil.judging.evidence import Evidence, Series
from tcs_hil.hil.judging.limits import Check, Quantity, worst_sample
from tcs_hil.hil.judging.measured import CannotJudgeError, Measured
from tcs_hil.hil.judging.of_run import RUN_METRICS, stretch
from tcs_hil.hil.judging.of_signal import SIGNAL_METRICS, Aim, SignalMetric


def prepare(expect: Expect, database: str | None) -> Check:
    """Find what ``expect`` names; ``database`` is the DBC of the bus, None the built-in one.

    Raises:
        ConfigError: a signal, metric or label is unknown, or the metric needs
            something that is not given.
    """
    names = namespace(database)
    if expect.metric is None:
        quantity = _signal(expect, names.find(str(expect.signal)))
    elif expect.signal is None:
        quantity = _run_metric(expect, names)
    else:
        quantity = _signal_metric(expect, names.find(expect.signal))
    to_s = math.inf if expect.to_s is None else expect.to_s
    limit = number(expect.value, quantity.labels, quantity.name)
    return Check(quantity, expect.op, limit, expect.from_s, to_s)


def _signal(expect: Expect, channel: Channel) -> Quantity:
    """In every sample: the worst one is measured."""
    _refuse(expect, ("target", "band"))
    limit = number(expect.value, channel.labels, str(channel))

    def measure(evidence: Evidence, from_s: float, to_s: float) -> Measured:
        return worst_sample(_samples(evidence, channel, from_s, to_s), expect.op, limit)

    return Quantity(str(channel), channel.unit, measure, channel.labels, channel.clocked)


def _run_metric(expect: Expect, names: Namespace) -> Quantity:
    name = str(expect.metric)
    if name in SIGNAL_METRICS:
        raise ConfigError(f"metric {name!r} is of a signal: name the `signal`, too")
    if name not in RUN_METRICS:
        known = [*RUN_METRICS, *SIGNAL_METRICS]
        # A signal may have been taken for a metric; without a likeness the metrics are offered.
        near = get_close_matches(name, map(str, names), n=1)
        raise ConfigError(f"there is no metric {name!r}{offer(name, known + near)}")
    metric = RUN_METRICS[name]
    _refuse(expect, ("target", "band"))
    if metric.whole and (expect.from_s > 0.0 or expect.to_s is not None):
        raise ConfigError(f"metric {name!r} is of the whole run: it takes no window")

    def measure(evidence: Evidence, from_s: float, to_s: float) -> Measured:
        return metric.measure(stretch(evidence, from_s, to_s))

    return Quantity(name, metric.unit, measure, clocked=metric.clocked)


def _signal_metric(expect: Expect, channel: Channel) -> Quantity:
    metric = _found(str(expect.metric))
    _require(expect, metric.needs)
    aim = Aim(
        math.nan if expect.target is None else number(expect.target, channel.labels, str(channel)),
        math.nan if expect.band is None else expect.band,
        exact=isinstance(expect.target, str),
    )

    def measure(evidence: Evidence, from_s: float, to_s: float) -> Measured:
        return metric.measure(_samples(evidence, channel, from_s, to_s), aim)

    labels = channel.labels if metric.unit is None and not metric.per_second else {}
    unit, clocked = metric.unit_for(channel.unit), channel.clocked
    return Quantity(_in_words(expect, channel), unit, measure, labels, clocked)


def _found(name: str) -> SignalMetric:
    if name in RUN_METRICS:
        raise ConfigError(f"metric {name!r} is of the whole run: leave out `signal`")
    if name not in SIGNAL_METRICS:
        raise ConfigError(f"there is no metric of a signal {name!r}{offer(name, SIGNAL_METRICS)}")
    return SIGNAL_METRICS[name]


def _in_words(expect: Expect, channel: Channel) -> str:
    words = f"{expect.metric} of {channel}"
    if expect.target is not None:
        words += f", target {expect.target}"
    return words if expect.band is None else f"{words} ± {expect.band:g}"


def _require(expect: Expect, needed: Set[str]) -> None:
    for key in ("target", "band"):
        if key in needed and getattr(expect, key) is None:
            raise ConfigError(f"metric {expect.metric!r} needs a `{key}`")
    _refuse(expect, tuple({"target", "band"} - needed))


def _refuse(expect: Expect, keys: tuple[str, ...]) -> None:
    """A key that changes nothing would mislead."""
    for key in keys:
        if getattr(expect, key) is not None:
            raise ConfigError(f"`{key}` means nothing to {expect.metric or expect.signal!r}")


def _samples(evidence: Evidence, channel: Channel, from_s: float, to_s: float) -> Series:
    samples = evidence.series(channel).between(from_s, to_s)
    if not samples.values.size:
        raise CannotJudgeError(f"there is no sample of {channel} in the window")
    return samples
