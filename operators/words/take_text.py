"""Wording of what was done to the take around the adapted frames."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from math import degrees, hypot

from ...bridge.companions.found import Companions
from ...bridge.controls.missed.aimed import Aimed
from ...bridge.controls.missed.kept import FAR_MM, TURNED_DEG, KeptByControls
from ...bridge.loops.write_loop import WrittenLoop
from ...bridge.polish.pins import MovedPin
from ...bridge.polish.put_on import PlacedPolish
from ...bridge.takes.span import WrittenTake
from ...solver.data.requests import PoseRequest

LEAST_SHIFT_MM = 5.0  # of the centre of mass, by which a flight is hardly told from a parabola
_LEVEL = 0.0005  # m
_STRAIGHT = 0.05  # degrees


def take_lines(
    written: WrittenTake | WrittenLoop | None, roles: Mapping[str, str] | None = None
) -> list[str]:
    """Lines for sidebar and report; none where the adapted frames are alone.

    roles: what stances are to the clip, by their phases' names, where the artist sees them so.
    """
    if written is None:
        return []
    if isinstance(written, WrittenLoop):
        controls = () if written.controls is None else _controls(written.controls)
        return [*controls, *_companions(written.companions)]
    return list(_lines(written, roles or {}))


def take_record(written: WrittenTake | WrittenLoop) -> dict[str, object]:
    """What report.json holds of it; of a loop, which is no part of its take, how near controls come
    to it, and its helper bones. Frames are the result's, lengths m, angles degrees."""
    if isinstance(written, WrittenLoop):
        kept: dict[str, object] = {"bones_kept_on_body": dict(written.companions.followers)}
        if written.controls is not None:
            kept["controls"] = asdict(written.controls)
        return kept
    span, move = written.span, written.moved
    record: dict[str, object] = {
        "adapted_frames": [span.first, span.last],
        "take_frames": [min(span.begin, span.first), max(span.end, span.last)],
        "blend_in_frames": len(span.before),
        "blend_out_frames": len(span.after),
        "kept_at_end": span.kept,
        "later_frames": written.later,
        "curves_applied": list(written.applied),
        "bones_held": list(written.held),
        "root_along": written.companions.root,
        "bones_kept_on_body": dict(written.companions.followers),
    }
    if written.controls is not None:
        record["controls"] = asdict(written.controls)
    if move is not None:
        record["carried_with"] = move.phase
        record["carried_m"] = list(move.shift)
        record["carried_turn_deg"] = degrees(move.turn)
        record["back_frame"] = written.back
        record["slide_on_way_back_m"] = written.slide
    return record


def _lines(written: WrittenTake, roles: Mapping[str, str]) -> Iterator[str]:
    span = written.span
    yield f"Take: frames {span.first:g} to {span.last:g} are adapted"
    ways = (("in", span.before), ("out", span.after))
    blends = [f"{way} over {_frames(len(frames))}" for way, frames in ways if len(frames)]
    if blends:
        yield f"Blended {' and '.join(blends)}"
    if round(100.0 * span.kept):
        yield (
            f"  The take ends within its blend of {_frames(round(span.blend_out))}: its last frame "
            f"keeps {100.0 * span.kept:.0f}% of what the adapted ones are off the take"
        )
    if written.later:
        way = "later" if written.later > 0 else "earlier"
        yield f"What follows comes {_frames(abs(written.later))} {way}"
    if written.moved is not None:
        yield from _carried(written, roles)
    if written.controls is not None:
        yield from _controls(written.controls)
    yield from _companions(written.companions)
    if written.held:
        yield f"Held still, for they moved joints within the body: {', '.join(written.held)}"
    if written.applied:
        yield f"Curves with modifiers, or muted, are plain keys now: {', '.join(written.applied)}"


def _companions(companions: Companions) -> Iterator[str]:
    if companions.root is not None:
        yield f"{companions.root} goes along with the hips over the floor, as in the take"
    if companions.followers:
        pairs = ", ".join(f"{bone} ({body})" for bone, body in companions.followers)
        yield f"Kept where they are on the body in the take: {pairs}"


def polish_lines(polish: PlacedPolish | None) -> list[str]:
    """Lines about hand polish of the last result that was put on the new one."""
    if polish is None:
        return []
    name, frames, told = polish.polish.result.name, polish.frames, list(polish.polish.unkept)
    if len(frames):
        count = len(polish.polish.offsets)
        channels = "1 channel" if count == 1 else f"{count} channels"
        where = f"at frame {frames[0]:g}"
        if len(frames) > 1:
            where = f"between frames {frames[0]:g} and {frames[-1]:g}"
        told.append(f"Hand polish of {name} is kept: {channels}, {where}")
    if polish.lost is not None:
        first, last = polish.lost
        told.append(
            f"Hand polish of {name} on frames {first:g} to {last:g} stays behind: this result has "
            "no such frames"
        )
    return told


def aimed_line(aimed: Aimed) -> str:
    """A line about neck and head that go on being aimed."""
    constraints = f"constraints ({', '.join(aimed.constraints)})" if aimed.constraints else ""
    by = " and ".join(each for each in (constraints, "drivers" if aimed.drivers else "") if each)
    far = "; for less, mute them, or bake the action" if aimed.mm > LEAST_SHIFT_MM else ""
    return (
        f"Left to {by}, as in the recording: {', '.join(aimed.bones)}, up to {aimed.degrees:.0f}° "
        f"from the solution (frame {aimed.frame:g}); the centre of mass is off by "
        f"{aimed.mm:.1f} mm at most{far}"
    )


def apart_lines(poses: Sequence[PoseRequest], bodies: Sequence[str]) -> list[str]:
    """Lines about poses that leave out what is aimed. bodies: names of the figure's bones."""
    told = []
    for pose in poses:
        apart = [b for b in bodies if b in pose.apart and (not pose.bones or b in pose.bones)]
        if apart:
            told.append(
                f"The pose “{pose.name}” is about the rest of the body: {', '.join(apart)} "
                f"{'stays' if len(apart) == 1 else 'stay'} aimed"
            )
    return told


def pin_lines(pins: Sequence[MovedPin]) -> list[str]:
    """Warnings about pinned points that hand polish moves."""
    return [
        f"Hand polish moves {pin.name} by {1000.0 * pin.distance:.0f} mm at frame {pin.frame:g}"
        for pin in pins
    ]


def _carried(written: WrittenTake, roles: Mapping[str, str]) -> Iterator[str]:
    move = written.moved
    assert move is not None
    parts = [f"{hypot(*move.shift[:2]):.3f} m along the ground"]
    if abs(move.shift[2]) > _LEVEL:
        parts.append(f"{abs(move.shift[2]):.3f} m {'up' if move.shift[2] > 0.0 else 'down'}")
    if abs(degrees(move.turn)) > _STRAIGHT:
        side = "left" if move.turn > 0.0 else "right"
        parts.append(f"{abs(degrees(move.turn)):.1f}° to the {side}")
    yield f"What follows is carried along with {roles.get(move.phase, move.phase)}:"
    yield f"  {', '.join(parts)}"
    if written.back is not None:
        yield f"  It is back where it was at frame {written.back:g}"


def _controls(kept: KeptByControls) -> Iterator[str]:
    if kept.kept:
        yield (
            f"{kept.controls} controls have keys; bones are within {kept.mm:.2f} mm "
            f"({kept.far_bone}, frame {kept.far_frame:g}) and {kept.degrees:.2f}° "
            f"({kept.turned_bone}, frame {kept.turned_frame:g})"
        )
        return
    yield (
        f"{kept.controls} controls have keys, and miss the solution by more than {FAR_MM:g} mm or "
        f"{TURNED_DEG:g}°:"
    )
    for miss in kept.worst:
        far = [f"{miss.mm:.1f} mm (frame {miss.far_frame:g})"] * (miss.mm > FAR_MM)
        turned = [f"{miss.degrees:.1f}° (frame {miss.turned_frame:g})"]
        told = far + turned * (miss.degrees > TURNED_DEG)
        if told:
            yield f"  {miss.bone} by {', '.join(told)}"


def _frames(count: int) -> str:
    return "1 frame" if count == 1 else f"{count} frames"
