"""Everything a port meets, added up to one condition of the bus.  Pure."""

from __future__ import annotations

from tcs_hil.canbus.error_frame import read_error_frame
from tcs_hil.signals import BusCondition


class BusHealth:
    """Remembers the worst since it was last asked, and what lasts until it is mended.

    An overflow or a failed send is over with the tick.  A link that is down
    lasts until a frame could be sent again; a controller that is error-passive
    or off the bus until it says otherwise.  One that is off the bus hears
    nothing, so a frame from it means that it is back, should its driver keep
    silent about that.
    """

    def __init__(self) -> None:
        self._worst = BusCondition.OK
        self._controller = BusCondition.OK
        self._link = BusCondition.OK

    def condition(self) -> BusCondition:
        """Worst since the last call, or what still lasts."""
        worst, self._worst = self._worst, BusCondition.OK
        return max(worst, self._link, self._controller)

    def heard(self) -> None:
        """A frame of another node has come."""
        if self._controller is BusCondition.BUS_OFF:
            self._controller = BusCondition.OK

    def sent(self) -> None:
        """The bus has taken a frame."""
        self._link = BusCondition.OK

    def send_failed(self) -> None:
        """The bus has not taken a frame: no buffer, or nobody who reads."""
        self._note(BusCondition.SEND_FAILED)

    def overflowed(self) -> None:
        """Frames were lost for want of room."""
        self._note(BusCondition.OVERFLOW)

    def link_lost(self) -> None:
        """The interface is down or gone.  Its controller begins anew when it comes back."""
        self._note(BusCondition.DOWN)
        self._link = BusCondition.DOWN
        self._controller = BusCondition.OK

    def error_frame(self, error_class: int, data: bytes) -> None:
        """The controller has reported something; arguments as of ``read_error_frame``."""
        report = read_error_frame(error_class, data)
        if report.controller is not None:
            self._controller = report.controller
            self._note(report.controller)
        self._note(report.passing)

    def _note(self, condition: BusCondition) -> None:
        self._worst = max(self._worst, condition)
