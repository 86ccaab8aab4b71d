"""The processor's cores: their speed, and who else runs on them."""

from __future__ import annotations

from tcs_hil.runtime.doctor.finding import Finding, ok, warn
from tcs_hil.runtime.doctor.machine import Machine

CPUS = "/sys/devices/system/cpu"


def governor(machine: Machine) -> Finding:
    """Whether cores slow down between two ticks."""
    what = "frequency governor"
    files = machine.glob(f"{CPUS}/cpu[0-9]*/cpufreq/scaling_governor")
    names = sorted({name for file in files if (name := machine.read(file))})
    if not names:
        return ok(what, "none: nothing here changes the frequency")
    if names == ["performance"]:
        return ok(what, f"performance on {len(files)} cores")
    return warn(what, ", ".join(names), "cpupower frequency-set --governor performance")


def isolation(machine: Machine) -> Finding:
    """Whether a core is kept free of other work."""
    what, isolated = "isolated cores", machine.read(f"{CPUS}/isolated")
    if isolated:
        return ok(what, f"{isolated}: set tick.cpu to one of them")
    last = (machine.read(f"{CPUS}/online") or "0").replace(",", "-").rpartition("-")[2]
    if last == "0":
        return warn(what, "none, and a single core", "use a machine with more than one core")
    return warn(
        what, "none", f"boot with isolcpus={last} nohz_full={last} and set tick.cpu = {last}"
    )
