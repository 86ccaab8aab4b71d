"""The daemon's life: open, announce, tick until told to stop, sum up."""

from __future__ import annotations

import platform
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from tcs_hil.canbus.bus import choose_interface
from tcs_hil.canbus.port import CanPort, open_port
from tcs_hil.native import tick_is_compiled
from tcs_hil.runtime import recording
from tcs_hil.runtime.clock import Clock, MonotonicClock
from tcs_hil.runtime.frame_trigger import FrameTrigger
from tcs_hil.runtime.lockstep import LockstepTrigger
from tcs_hil.runtime.loop import Loop
from tcs_hil.runtime.notify import Watchdog, notify
from tcs_hil.runtime.realtime import prepare
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import RunInfo
from tcs_hil.runtime.stop import StopRequest
from tcs_hil.runtime.summary import Summary, summarise
from tcs_hil.runtime.trigger import TimerTrigger, Trigger
from tcs_hil.service.bus_end import BusEnd, bus_end
from tcs_hil.service.claim import ChannelClaim
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import backend_of, build_laws, build_pipeline

NS_PER_US = 1_000
NS_PER_S = 1_000_000_000


def serve(config: ServiceConfig, announce: Callable[[str], None]) -> Summary:
    """Run the service until SIGTERM or SIGINT and sum the run up.

    Raises:
        TcsError: DBC, model, interface or recording cannot be used, or another
            service has the channel.
    """
    clock = MonotonicClock(config.tick.spin_us * NS_PER_US)
    end = bus_end(config)
    laws = build_laws(config, clock)
    with ExitStack() as cleanup:
        stop = cleanup.enter_context(StopRequest())
        interface, description = choose_interface(config.bus.interface, config.bus.channel)
        cleanup.enter_context(ChannelClaim(interface, config.bus.channel))
        port, _ = open_port(interface, config.bus.channel, config.bus.bitrate)
        cleanup.callback(port.close)
        path = _recording_path(config, cleanup)
        recorder = cleanup.enter_context(_recorder(config, path, description))
        loop = Loop(
            trigger=_trigger(config, clock, port, end),
            port=port,
            node=end.node,
            pipeline=build_pipeline(config, laws),
            laws=laws,
            clock=clock,
            write=recorder.write,
            healthy=Watchdog().feed,
        )
        announce(f"bus: {description}")
        announce(
            f"controller: {config.controller} ({backend_of(config)}), "
            f"slip reference {config.control.slip_reference}, "
            f"tick {'compiled' if tick_is_compiled() else 'interpreted'}"
        )
        if config.tick.trigger != "lockstep":
            for grant in prepare(config.tick.cpu, config.tick.priority):
                announce(f"{'with' if grant.got else 'without'} {grant.what} ({grant.why})")
        notify("READY=1")
        loop.run(stop.requested)
        notify("STOPPING=1")
        return summarise(recording.read(path))


def _trigger(config: ServiceConfig, clock: Clock, port: CanPort, end: BusEnd) -> Trigger:
    period_ns = _period_ns(config)
    if config.tick.trigger == "lockstep":
        return LockstepTrigger(clock, port, end.node, end.bench_tick_id, period_ns)
    if config.tick.trigger == "frame":
        # The last wheel speeds of a cycle: once they are there, all of it is.
        return FrameTrigger(clock, port, end.last_wheel_id, period_ns)
    return TimerTrigger(clock, port, period_ns, config.tick.phase_us * NS_PER_US)


def _recorder(config: ServiceConfig, path: Path, bus: str) -> FlightRecorder:
    run = RunInfo(
        period_ns=_period_ns(config),
        started_monotonic_ns=time.monotonic_ns(),
        started_realtime_ns=time.time_ns(),
        controller=config.controller,
        backend=backend_of(config),
        bus=bus,
        machine=f"{platform.node()} {platform.release()} {platform.machine()}",
    )
    return FlightRecorder(path, run, config.recorder.ticks)


def _recording_path(config: ServiceConfig, cleanup: ExitStack) -> Path:
    """Where the recording goes: without a wish it only lives until it has been summed up."""
    if config.recorder.path is not None:
        return Path(config.recorder.path)
    return Path(cleanup.enter_context(tempfile.TemporaryDirectory(prefix="tcs-hil."))) / "flight"


def _period_ns(config: ServiceConfig) -> int:
    return round(config.control.period_s * NS_PER_S)
