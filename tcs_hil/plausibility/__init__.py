"""Which inputs cannot be true, by physics and by what the others say.  Pure; plain floats.

Rolling wheels do not jump, agree as far as a curve lets them, follow the
acceleration, and are not faster than every driven wheel.  Driven wheels may slip,
but turn with their motors.  No motor gives more than the driver asks.  All speeds
in here are those of a wheel's rim, without sign; NaN is one nobody vouches for.
"""

from tcs_hil.plausibility.screen import Plausibility, screened

__all__ = ["Plausibility", "screened"]
