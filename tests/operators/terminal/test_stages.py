"""A job's stages on the terminal: each tells how it ended."""

from io import StringIO

import pytest
from hangtime.operators.terminal.stages import Stages


@pytest.mark.parametrize(
    ("why", "said"), [(KeyboardInterrupt, "cancelled"), (ValueError, "failed")]
)
def test_a_stage_that_does_not_end_says_why(why: type[BaseException], said: str) -> None:
    out = StringIO()
    stages = Stages(out)
    with stages.stage("Importing"):
        pass
    with pytest.raises(why), stages.stage("Fitting"):
        raise why
    first, second = out.getvalue().splitlines()
    assert first.startswith("Importing")
    assert first.endswith(" s")
    assert second.startswith("Fitting")
    assert second.endswith(f"   {said}")
    assert [stage.name for stage in stages.done] == ["Importing", "Fitting"]
