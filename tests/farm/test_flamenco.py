"""The job type for Flamenco, in an engine of JavaScript with what Flamenco's Manager gives it."""

import json
from pathlib import Path
from typing import Any

import dukpy
import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "farm" / "flamenco" / "hangtime_batch.js"
MANAGER = Path(__file__).with_name("flamenco_manager.js")
# Of Flamenco's API: AvailableJobSetting, and the values of its enumerations.
KEYS = {"key", "type", "subtype", "choices", "propargs", "description", "label", "default", "eval"}
KEYS |= {"evalInfo", "visible", "required", "editable"}
TYPES = {"string", "int32", "float", "bool"}
SUBTYPES = {"file_path", "dir_path", "file_name", "hashed_file_path"}
VISIBLE = {"visible", "hidden", "submission", "web"}


def in_manager(expression: str) -> Any:
    """The value of an expression where script and Manager are loaded."""
    return dukpy.evaljs([MANAGER.read_text(), SCRIPT.read_text(), expression])


def compiled(**settings: Any) -> list[dict[str, Any]]:
    """The tasks that the script makes of a submitted job."""
    job = json.dumps({"name": "jumps", "settings": settings})
    return list(in_manager(f"compiled({job})"))


def test_its_settings_are_such_as_flamenco_knows() -> None:
    job_type = in_manager("JOB_TYPE")
    assert set(job_type) == {"label", "description", "settings"}
    for setting in job_type["settings"]:
        assert set(setting) <= KEYS
        assert setting["type"] in TYPES
        assert setting.get("subtype", "dir_path") in SUBTYPES
        assert setting.get("visible", "visible") in VISIBLE
        assert setting.get("required") or "default" in setting


def test_a_task_a_cell_and_one_that_collects_after_all_of_them() -> None:
    *cells, collect = compiled(batch_folder="/jobs/Sprünge 1", cells="1-3,7")
    assert [task["name"] for task in cells] == ["cells-1", "cells-2", "cells-3", "cells-7"]
    assert all(task["type"] == "misc" and not task["dependencies"] for task in cells)
    assert [task["commands"] for task in cells][3] == [
        {
            "name": "exec",
            "parameters": {"exe": "hangtime-batch", "args": ["task", "/jobs/Sprünge 1", "7"]},
        }
    ]
    assert collect["dependencies"] == [task["name"] for task in cells]
    (command,) = collect["commands"]
    assert command["parameters"]["args"] == ["collect", "/jobs/Sprünge 1"]


def test_tasks_of_several_cells_with_a_program_of_the_managers_choice() -> None:
    tasks = compiled(
        batch_folder="/jobs/a", cells="1-10,12", cells_per_task=4, program="{hangtime}"
    )
    arguments = [task["commands"][0]["parameters"]["args"][-1] for task in tasks[:-1]]
    assert arguments == ["1-4", "5-8", "9,10,12"]
    assert {task["commands"][0]["parameters"]["exe"] for task in tasks} == {"{hangtime}"}


def test_what_is_no_range_makes_no_job() -> None:
    with pytest.raises(dukpy.JSRuntimeError, match="invalid range"):
        compiled(batch_folder="/jobs/a", cells="all")
