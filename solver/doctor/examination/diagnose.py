"""The examination: each fault is sought in the recording as the remedies before it leave it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, reduce

import numpy as np

from ...analysis.analyse import require_dense
from ...analysis.performance import Performance, find_contacts, perform
from ...arrays import FloatArray
from ...body.character import build_character, stature
from ...data.contacts import ContactSchedule
from ...data.faults import ClipTooShort, computable
from ...data.recording import MIN_CLIP_DURATION, Recording, Skin
from ...data.scaling import scaled_recording
from ...data.scene import SceneObject
from ...scene.support import StandingGround
from ...skeleton.bind_pose import bind_frames, last_bind_frames
from ..falls import FEWEST, LEAP_WINDOW, Spans, Trusted, find_leaps, person_factor
from ..figure import figure_of
from ..finding import Finding, FindingKind
from ..frames.exchanges import KINDS, LIMBS, find_exchange
from ..frames.flips import find_flips
from ..frames.full_turns import find_full_turns
from ..frames.holds import find_held, find_repeated
from ..frames.jumps import find_jumps, with_those_left
from ..frames.missing import find_dropped
from ..frames.rate_conversion import find_conversion
from ..frames.spikes import find_spikes
from ..lengths import find_lengths
from ..noise import find_noise, reach
from ..repairs import Repairs
from ..retimed import explained, find_retimed
from ..stance.feet import find_sliding_feet
from ..stance.footing import find_footing
from ..stance.in_place import find_in_place
from ..stance.level_hips import find_level_hips
from ..stance.tilted import find_tilt
from ..stretch import CUTTING, Span, longest_stretch
from ..upright import find_up
from .drifts import find_drifts
from .ground import as_stood, beneath
from .repair import GROUNDING, placed_skin, repaired, taken_out
from .scales import find_scales, without_unseen
from .settled import Stance, joined_remedies, remedy_of, settled
from .without_height import find_what_is_left

PARTING = (FindingKind.JUMP, FindingKind.LEAP)
# What moves the feet along the floor with the body; where it is told they slide for that.
WHOLE_BODY = (FindingKind.SLIDING, FindingKind.IN_PLACE, FindingKind.FLOATING)
LEAST_KEPT = 0.5  # s; of less nobody makes a range
GAPS = (FindingKind.DROPPED_FRAMES, FindingKind.JUMP)
MASS_BY_SQUARE = (12.0, 42.0)  # kg/m²; children have 14, the heaviest who jump 40
FEWEST_FRAMES = 5  # which have a fourth difference
SLOWEST = 1.0  # s from frame to frame, Blender's slowest rate: a wrong one is told, and its remedy
USUAL_MASS_BY_SQUARE = 22.0  # kg/m²


@dataclass(frozen=True)
class Diagnosis:
    """What was found, in the order in which it is repaired. mass: kg, that fits the size; None
    where the stated one does, or none was. kept: the first and last scene frame that all remedies
    together leave."""

    findings: tuple[Finding, ...]
    mass: float | None = None
    kept: Span = (-np.inf, np.inf)

    @property
    def repairs(self) -> Repairs:
        """All remedies together. Frames that are put in count for those left out at both ends, so
        where they would be left out again none are."""
        first, last = self.kept
        every = reduce(Repairs.joined, (f.remedy for f in self.findings if f.remedy), Repairs())
        inside = tuple(gap for gap in every.missing if first <= gap.after < last)
        return replace(every, missing=inside)

    def counted_in(self, whole: Span, examined: Span) -> Diagnosis:
        """With the frames that are left out counted from both ends of the whole clip, of which some
        were examined. Both: first and last frame."""
        before, after = round(examined[0] - whole[0]), round(whole[1] - examined[1])

        def counted(cut: Repairs) -> Repairs:
            first, last = cut.trim and before + cut.trim, cut.trim_end and after + cut.trim_end
            return replace(cut, trim=first, trim_end=last)

        findings = (replace(f, remedy=f.remedy and counted(f.remedy)) for f in self.findings)
        return replace(self, findings=tuple(findings))


@computable()
def diagnose(
    recording: Recording,
    chosen: Mapping[str, str] | None = None,
    mass: float | None = None,
    skin: Skin | None = None,
    scene: Sequence[SceneObject] = (),
    told: Callable[[float], None] = lambda _: None,
    carried: Spans = (),
) -> Diagnosis:
    """chosen: bones by parts of the body, as in a problem. mass: kg, as stated by the artist. skin:
    of the figure, with whose soles it stands. scene: objects of which ground explains where it
    stands, and what it rides on. told: hears now and then the share, 0 to 1, of the time of a long
    take that is over; of what is done again it hears once more. carried: scene frames in which
    contacts touch that are stated, whatever is found.

    Raises ClipTooShort, FramesFarApart, MissingPart, NotComputable, ZeroLengthBone.
    """
    _require_length(recording)
    found: list[Finding] = []
    frames, rate = recording.frames, recording.rate

    def cured(recording: Recording, finding: Finding | None) -> Recording:
        """Keeps a finding; the recording with its remedy."""
        if finding is None:
            return recording
        found.append(finding)
        return repaired(recording, remedy_of(finding), chosen)

    up = find_up(recording, figure_of(recording, chosen))
    recording, skin = cured(recording, up), placed_skin(skin, remedy_of(up))
    recording = cured(recording, _find_bind_pose(recording))
    _require_length(recording)
    figure = figure_of(recording, chosen)
    size = person_factor(stature(recording, chosen))
    recording = scaled_recording(recording, size)  # limits in metres are those of persons
    told(0.05)
    recording = cured(recording, find_full_turns(recording, figure))
    recording = cured(recording, find_conversion(recording))
    recording = cured(recording, find_held(recording))
    repeated = find_repeated(recording)
    if repeated is not None:  # and cured without another number for any frame
        found.append(repeated)
        recording = taken_out(recording, remedy_of(repeated).missing)
    for limbs in LIMBS:
        recording = cured(recording, find_exchange(recording, figure, limbs))
    told(0.1)
    for find in (find_flips, find_spikes):
        recording = cured(recording, find(recording, figure))
    told(0.2)
    dropped = find_dropped(recording)
    if dropped is not None:
        found.append(dropped)  # and not cured: what else is found is told by the frames that are
    gaps = _places(found, FindingKind.DROPPED_FRAMES)
    jumps = find_jumps(recording, figure, gaps)
    if jumps is not None:
        found.append(with_those_left(jumps, recording, figure, gaps))
    told(0.35)
    recording = cured(recording, find_lengths(recording, figure))
    noise, trembling = find_noise(recording, figure), recording
    recording = cured(recording, noise)
    told(0.4)
    level = find_level_hips(trembling, figure)  # smoothed after that is mended
    recording = scaled_recording(recording if level is None else trembling, 1.0 / size)
    rides = bool(StandingGround.of(-np.inf, scene, recording).carriers)

    def offered(findings: Iterable[Finding]) -> tuple[Finding, ...]:
        """Of who rides on something it is told how he stands there, but mended is how he does so
        in the world: no remedy is offered that would take the ride for it."""
        return tuple(
            replace(f, remedy=None) if rides and GROUNDING & {*remedy_of(f).mend} else f
            for f in findings
        )

    @cache
    def performed(repairs: Repairs) -> Performance:
        mended = repaired(recording, repairs, chosen)
        character = build_character(mended, chosen=chosen)
        return perform(mended, character, placed_skin(skin, repairs))

    @cache
    def touched(repairs: Repairs) -> ContactSchedule:
        performance = performed(repairs)
        told(0.65)
        return without_unseen(performance, find_contacts(performance, scene), carried)

    trusted, seconds = _trusted(found, rate, carried), float(recording.times[-1])

    def stood(repairs: Repairs) -> Performance:
        return as_stood(performed(repairs), scene)

    def keep() -> Span | None:
        """What is worth keeping; without the rest, where the recording is parted."""
        nonlocal recording
        kept = _kept(found, frames, rate)
        if kept is not None and any(finding.kind in PARTING for finding in found):
            found[:] = _parted(found, frames, kept)
            # How it stands elsewhere is no matter, and may differ.
            recording = recording.window(*kept)
            performed.cache_clear()
            touched.cache_clear()
        return kept

    def diagnosis(height: float, kept: Span | None) -> Diagnosis:
        """With the mass, where the stated one does not go with a height, m."""
        fitting = None
        if mass is not None and not (MASS_BY_SQUARE[0] < mass / height**2 < MASS_BY_SQUARE[1]):
            fitting = USUAL_MASS_BY_SQUARE * height**2
            found.append(Finding(FindingKind.MASS, mass, "kg"))
        return Diagnosis(tuple(found), fitting, kept or Diagnosis.kept)

    if level is not None:
        kept = keep()
        given = remedy_of(noise).joined(remedy_of(level))
        left = find_what_is_left(stood, touched, given)
        found += offered([level, *left])
        return diagnosis(stood(joined_remedies(left)).character.height, kept)

    def moved(placed: Repairs) -> tuple[Finding, ...]:
        """Of hips whose own way was left out nothing else is told: falls are bent, too."""
        if (in_place := find_in_place(stood(placed))) is not None:
            return (in_place,)
        upright = performed(placed)
        tilt = find_tilt(upright, figure, beneath(upright.recording, scene))
        drifts = find_drifts(stood, figure, placed.joined(remedy_of(tilt)))
        return (tilt, *drifts) if tilt else tuple(drifts)

    def standing(placed: Repairs) -> Stance:
        drifts = offered(moved(placed))
        placed = placed.joined(joined_remedies(drifts))
        return Stance(drifts, offered(find_footing(stood(placed), touched(placed))))

    def find_part(placed: Repairs) -> Finding | None:
        """A part that was retimed; where all is, none is told apart."""
        return None if scales else find_retimed(performed(placed), trusted)

    scales = find_scales(performed, touched, trusted)
    told(0.95)
    leaps = find_leaps(performed(joined_remedies(scales)))
    if leaps is not None and not scales:  # a rise may hide the clock at which these are but falls
        scales, _ = settled(scales, standing, performed, touched, trusted)
        leaps = find_leaps(performed(joined_remedies(scales)))
    part = find_part(Repairs())
    near, torn = LEAP_WINDOW * recording.rate, _places(found, *GAPS)
    if leaps is not None and not _are_at(leaps, torn + (part.frames if part else ()), near):
        found.append(leaps)
    ends = recording.ends
    kept = keep()
    scales, stance = settled(scales, standing, performed, touched, trusted)
    found += scales
    seconds *= joined_remedies(scales).time_scale
    if seconds < MIN_CLIP_DURATION:
        found.append(Finding(FindingKind.TOO_SHORT, seconds, "s"))
    placed = joined_remedies((*scales, *stance.drifts))
    retimed = find_part(placed)
    if retimed is not None:
        found.append(retimed)
    found += stance.drifts
    footing = _uncut(stance.footing, recording.ends, ends)
    found += footing if retimed is None else explained(footing, retimed)
    feet = find_sliding_feet(stood(placed))
    if feet is not None and not any(finding.kind in WHOLE_BODY for finding in found):
        found.append(feet)
    return diagnosis(stood(placed).character.height, kept)


def _kept(found: list[Finding], frames: FloatArray, rate: float) -> Span | None:
    """The longest part of all frames (T,) that is worth keeping; None where none is."""
    whole = float(frames[0]), float(frames[-1])
    kept = longest_stretch(whole, (f for f in found if f.kind in CUTTING))
    return kept if kept[1] - kept[0] >= LEAST_KEPT * rate else None


def _parted(found: list[Finding], frames: FloatArray, kept: Span) -> list[Finding]:
    """The findings, with the remedy of those that part the frames (T,): all but what is kept."""
    first, last = np.searchsorted(frames, kept).tolist()
    cut = Repairs(trim=first, trim_end=len(frames) - 1 - last)
    return [replace(f, remedy=cut) if f.kind in PARTING else f for f in found]


def _uncut(footing: Iterable[Finding], kept: Span, whole: Span) -> tuple[Finding, ...]:
    """What is found of how a body stands in the frames that are kept, but that these begin or end
    in the air where the clip does not."""
    cut = {
        FindingKind.BEGINS_IN_AIR: kept[0] > whole[0],
        FindingKind.ENDS_IN_AIR: kept[1] < whole[1],
    }
    return tuple(finding for finding in footing if not cut.get(finding.kind, False))


def _trusted(found: list[Finding], rate: float, carried: Spans) -> Trusted:
    """The falls that tell the clock; of what was smoothed those that are longer than its window.
    carried: frames in which contacts that are stated touch."""
    noisy = any(finding.kind is FindingKind.NOISE for finding in found)
    fewest = 2 * reach(rate) + 1 if noisy else FEWEST
    torn = _places(found, FindingKind.HELD_FRAMES, *KINDS.values(), *GAPS)
    return Trusted(fewest, torn, carried)


def _places(found: list[Finding], *kinds: FindingKind) -> Spans:
    """Where something of these kinds was found."""
    return tuple(span for finding in found if finding.kind in kinds for span in finding.frames)


def _are_at(finding: Finding, places: Spans, near: float) -> bool:
    """Whether nothing of a finding is elsewhere. near: frames, by which it may miss them."""
    return all(
        any(a - near <= end and start <= b + near for start, end in places)
        for a, b in finding.frames
    )


def _require_length(recording: Recording) -> None:
    """What is shorter tells nothing. Raises ClipTooShort, FramesFarApart."""
    if len(recording.frames) < FEWEST_FRAMES:
        seconds, ends = float(recording.times[-1]), recording.ends
        raise ClipTooShort(seconds, MIN_CLIP_DURATION, ends, chosen=False)
    require_dense(recording, SLOWEST)


def _find_bind_pose(recording: Recording) -> Finding | None:
    """At both ends; at the last in what the first leaves, as what is told for it could be all."""
    frames, first = recording.frames, bind_frames(recording)
    last = last_bind_frames(recording.part(slice(first, None)))
    if first + last == 0:
        return None
    begins = [(float(frames[0]), float(frames[first - 1]))] if first else []
    ends = [(float(frames[-last]), float(frames[-1]))] if last else []
    remedy = Repairs(trim=first, trim_end=last)
    held = float(first + last)
    return Finding(FindingKind.BIND_POSE, held, "frames", (*begins, *ends), remedy=remedy)
