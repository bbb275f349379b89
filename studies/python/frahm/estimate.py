"""A parameter found from data."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Estimate:
    """A parameter found, with its numbers in `unit`: that of SI, whatever the study's own is.

    Given as the value of a parameter it is taken with its unit: study.with_parameters(k=found["k"]). Its value alone
    would be a number in the parameter's usual unit. NaN: the data do not determine it.
    """

    value: float
    low: float  #: ends of the 95 % interval
    high: float
    standard_error: float
    unit: str  #: empty for a pure number, and in a dimensionless study

    def __float__(self) -> float:
        return self.value

    def setting(self, name: str) -> str:
        """The value that a parameter is set to, with its unit.  name: of the parameter, for messages."""
        if not math.isfinite(self.value):
            raise ValueError(f"{name}: the data do not determine this estimate")
        return f"{self.value!r} {self.unit}".rstrip()

    def __str__(self) -> str:
        return f"{self.value:.6g} [{self.low:.6g}, {self.high:.6g}] {self.unit}".rstrip()
