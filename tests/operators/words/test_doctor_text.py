"""Every finding has a sentence that says what, where and the remedy."""

from hangtime.operators.words.doctor_text import (
    HEALTHY,
    SENTENCES,
    diagnosis_text,
    finding_sentence,
    remedy_label,
)
from hangtime.solver.doctor.examination.diagnose import Diagnosis
from hangtime.solver.doctor.finding import Finding, FindingKind
from hangtime.solver.doctor.repairs import Repairs


def test_every_kind_has_a_sentence() -> None:
    assert set(SENTENCES) == set(FindingKind)
    for kind in FindingKind:
        told = finding_sentence(Finding(kind, 2.0, "", ((3.0, 3.0), (5.0, 9.0)), "Hand.L"))
        assert told.endswith(".")
        assert "{" not in told


def test_a_clock_that_is_wrong_offers_both_remedies() -> None:
    finding = Finding(
        FindingKind.TIME_SCALE,
        *(6.1, "m/s²", ((52.0, 75.0),), ""),
        remedy=Repairs(time_scale=0.78867),
        alternative=Repairs(scale=1.60801),
    )
    told = diagnosis_text(Diagnosis((finding,)))
    assert told == (
        "The body falls at 6.1 m/s² in frames 52 to 75, not at 9.8: it is played 1.27 times too "
        "slowly.\n    remedy: time_scale = 0.7887\n    or else: scale = 1.608\n"
    )


def test_what_is_off_is_told_by_its_unit_and_whose_it_is() -> None:
    spike = Finding(FindingKind.SPIKE, 60.2, "°", ((8.0, 9.0),), "Hand.L")
    assert "Hand.L by 60°: in frames 8 to 9." in finding_sentence(spike)
    root = Finding(FindingKind.SPIKE, 52.4, "cm", ((8.0, 8.0),), "Hips")
    assert "Hips by 52 cm: at frame 8." in finding_sentence(root)
    joined = Finding(FindingKind.JUMP, 40.0, "cm", ((8.0, 9.0),))
    assert finding_sentence(joined).startswith("The whole body jumps by 40 cm in frames 8 to 9,")
    thigh = Finding(FindingKind.JUMP, 48.0, "°", ((8.0, 9.0),), "Thigh.R")
    assert finding_sentence(thigh).startswith("Thigh.R jumps by 48° in frames 8 to 9,")


def test_bones_keep_their_names_at_the_start_of_a_sentence_and_places_are_counted() -> None:
    frames = tuple((float(frame), float(frame)) for frame in range(10, 80, 10))
    flip = Finding(FindingKind.FLIP, 180.0, "°", frames, "mixamorig:LeftUpLeg")
    assert finding_sentence(flip) == (
        "mixamorig:LeftUpLeg is turned by half a turn in frames 10, 20, 30, 40, 50, 60 and 1 more "
        "place."
    )


def test_a_single_frame_is_one() -> None:
    one, four = (
        Finding(FindingKind.DROPPED_FRAMES, n, "frames", ((8.0, 8.0),)) for n in (1.0, 4.0)
    )
    assert finding_sentence(one).startswith("About 1 frame is missing: ")
    assert finding_sentence(four).startswith("About 4 frames are missing: ")


def test_of_what_is_cut_everywhere_it_is_advised_to_choose() -> None:
    cut = Finding(FindingKind.JUMP, 40.0, "cm", ((8.0, 9.0),))
    assert finding_sentence(cut).endswith("Choose frames on one side of it.")
    once = Finding(FindingKind.JUMP, 40.0, "cm", ((8.0, 9.0),), remedy=Repairs(trim_end=30))
    assert "Choose" not in finding_sentence(once)
    assert remedy_label(once, Repairs(trim_end=30), 0.0, 24.0) == "Keep the Longest Part"
    assert "remedy: trim_end = 30\n" in diagnosis_text(Diagnosis((once,)))


def test_a_clean_recording_is_called_so_though_there_are_notes() -> None:
    note = Finding(FindingKind.ENDS_IN_AIR, 0.1, "s", ((20.0, 30.0),))
    assert diagnosis_text(Diagnosis((note,))).splitlines() == [
        HEALTHY,
        "note: The clip ends in the air.",
    ]


def test_remedies_are_called_by_what_they_set() -> None:
    clock = Finding(FindingKind.TIME_SCALE, 15.3, "m/s²")
    assert remedy_label(clock, Repairs(time_scale=1.25), 0.0, 150.0) == "Set 120 fps"
    assert remedy_label(clock, Repairs(scale=0.64), 0.0, 150.0) == "Scale × 0.64"
    sinking = Finding(FindingKind.RISING, -0.12, "m/s")
    assert remedy_label(sinking, Repairs(rise=-0.12), 0.0, 24.0) == "Hold Level"
    assert remedy_label(sinking, Repairs(floor=-0.24), 0.0, 24.0) == "Put on the Floor"
    sloping = Finding(FindingKind.TILTED, 1.5, "°")
    assert remedy_label(sloping, Repairs(tilt=(0.2, 1.48)), 0.0, 24.0) == "Turn Level"
    assert remedy_label(sloping, Repairs(rise=0.05), 0.0, 24.0) == "Hold Level"
    giant = Finding(FindingKind.SIZE, 30.1, "m")
    assert remedy_label(giant, Repairs(scale=0.05644), 0.0, 24.0) == "Scale to 1.70 m"
    heavy = Finding(FindingKind.MASS, 200.0, "kg")
    assert remedy_label(heavy, Repairs(), 68.4, 24.0) == "Set 68 kg"
