"""What a fit needs beside the recording is told, of reports and of a fit alone."""

from hangtime.operators.words.headline import accepted_lines
from hangtime.solver.data.reports.constraints import FitNeeds, LetGoReport, UnseenSupportReport


def test_all_frames_of_unseen_support_and_all_contacts_let_go_are_told() -> None:
    needs = FitNeeds(
        (
            UnseenSupportReport(1.0, 41.0, 4.74, 13.0, 0.1),
            UnseenSupportReport(58.0, 115.0, 1.36, 111.0, 0.3),
        ),
        (LetGoReport("Right heel 2", 29.0, 74.0, 66.0),),
    )
    support, contacts = accepted_lines(needs)
    assert "1 to 41 (4.74), 58 to 115 (1.36)" in support
    assert "Right heel 2" in contacts
    assert accepted_lines(FitNeeds()) == []
