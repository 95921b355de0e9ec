"""Records of the report's certificate: what a laboratory asks of a motion."""

from dataclasses import dataclass, field
from enum import Enum

from .omission import OMIT_NONE

AS_RECORDED = 1.05  # times the recording's value: no more is no worse


class CertificateItem(Enum):
    """What a line of the certificate is about."""

    RESIDUAL_FORCE_RMS_SHARE = "residual force, rms, of peak force"
    RESIDUAL_FORCE_PEAK_SHARE = "residual force, peak, of peak force"
    RESIDUAL_MOMENT_RMS_SHARE = "residual moment, rms, of peak force x height"
    RESIDUAL_MOMENT_PEAK_SHARE = "residual moment, peak, of peak force x height"
    RESIDUAL_FORCE_RMS = "residual force, rms"
    RESIDUAL_FORCE_PEAK = "residual force, peak"
    RESIDUAL_MOMENT_RMS = "residual moment, rms"
    RESIDUAL_MOMENT_PEAK = "residual moment, peak"
    FRICTION = "friction coefficient used"
    PEAK_FORCE = "peak force"
    LOADING_RATE = "loading rate"
    HIP_TORQUE = "peak hip torque"
    KNEE_TORQUE = "peak knee torque"
    ANKLE_TORQUE = "peak ankle torque"
    SLIDE = "loaded point slides"
    UNDER = "loaded point under its surface"
    ABOVE = "loaded point above its surface"
    FIT_RMS = "fit from the recording, rms"
    FIT_WORST_FRAME = "fit from the recording, worst frame"


@dataclass(frozen=True)
class CertificateLine:
    """One figure of the certificate. where: a contact or a side. frame: None for a mean.

    holds: whether the value is at most the limit. recorded: the value of the recording (its fit),
    None where that is not told, or the motion is that fit.
    """

    item: CertificateItem
    value: float
    unit: str
    limit: float
    holds: bool
    frame: float | None
    where: str
    recorded: float | None = field(default=None, metadata=OMIT_NONE)

    @property
    def as_recorded(self) -> bool:
        """Whether it does not hold, but in the recording neither, and is no better there."""
        if self.holds or self.recorded is None or self.recorded <= self.limit:
            return False
        return self.value <= AS_RECORDED * self.recorded
