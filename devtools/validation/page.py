"""docs/validation.md: the method, and the tables."""

from collections.abc import Sequence

from .table import Table

HEAD = """# Against force plates

`python3 dev.py validate [FOLDER] --page` wrote this page. It takes recordings with measured
ground forces, finds the contacts, fits, and sets the contact forces beside the plates'. The fit
knows the recording and the body's mass, nothing of the forces. `examples/recordings` holds one
such trial, `BMC_run`; the others here may not be redistributed (README of their folder), but
any folder in the same format will do.

- **Format.** `X.bvh` in centimetres, Y up, forward +Z, left +X. `X_grf.csv`: per foot force on
  the body (N) and centre of pressure (m) in the same axes, zero below 20 N. `X_com.csv`: the
  centre of mass of the laboratory's own model. `X.json`: `subject_mass_kg`, `kind`, `bvh_fps`,
  `bvh_frames`, `valid_window_s`, `baseline_window_s`, `direct_differentiation_baseline`.
- **Frames.** Those of the valid window, in which all support was measured; read through Blender,
  as `dev.py adapt` reads a clip.
- **Filter.** Butterworth of order 2, both ways (no delay), on both sides alike, at 10, 15 and 20
  Hz.
- **Window.** `baseline_window_s`: the valid window without the 60 ms that a filter's edge spoils,
  flights included; the same for all columns. Errors over the stances alone are told beside.
- **Plain differentiation**, the yardstick: the laboratory's centre of mass, by central
  differences twice, low-passed after. It needs no contacts and no body, and is no floor: the
  recording's own noise is in it. What it gives here is within 0.001 BW at 15 Hz of what the
  trials' files have stored.
- **A refused trial** is one on which the command line stops with that sentence; it counts as
  missed. A walk is judged by its error in body weights, for its baseline is near the noise.

**Constants.** Heights and speeds that tell a contact (`ContactThresholds`) were set on recordings
with measured forces, trials of this page among them. The comments at the other constants of the fit
say where they come from.
"""


def page(parts: Sequence[Table]) -> str:
    """The whole page."""
    return "\n\n".join([HEAD.rstrip(), *(part.markdown for part in parts)]) + "\n"
