"""From measurements to the state of the car: as the paper has it, or fused from every sensor."""

from tcs_hil.estimator.direct import Estimator
from tcs_hil.estimator.estimate import Estimate, Estimates

__all__ = ["Estimate", "Estimates", "Estimator"]
