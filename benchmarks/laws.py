"""The control laws that are compared, by the name they have on command lines and in tables."""

from __future__ import annotations

from tcs_hil.control.settings import ControlSettings
from tcs_hil.service.settings import ServiceConfig

PAPER = ControlSettings(preset="paper")
YARDSTICK = "pi"
LAWS = {
    "off": ServiceConfig(controller="off"),
    YARDSTICK: ServiceConfig(controller="pi"),
    "kmpc-paper": ServiceConfig(controller="kmpc", control=PAPER),
    "nmpc-paper": ServiceConfig(controller="nmpc", control=PAPER),
    "kmpc": ServiceConfig(controller="kmpc"),
    "nmpc": ServiceConfig(controller="nmpc"),
}
DEFAULTS = ("kmpc", "nmpc")
