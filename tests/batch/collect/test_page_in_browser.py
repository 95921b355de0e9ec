"""The page of a batch in a real browser, opened from its file: what is seen, clicked and typed.

Slow: installs Chromium where it is missing (Debian, root), and starts it several times.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hangtime.batch.collect.collecting import collect
from hangtime.batch.records.manifest import Manifest, read_manifest
from hangtime.batch.records.result import RESULT, State, cell_folder, read_result
from hangtime.bridge.picture.film import draw_film
from hangtime.bridge.picture.sheet import Limb, SheetRow
from hangtime.devtools.batch_page.browser import Browser, browser, ensure_browser
from hangtime.devtools.batch_page.made_up import HARD_NAMES, make_batch
from hangtime.devtools.batch_page.measure import measure_page

pytestmark = pytest.mark.slow

READY = "return document.documentElement.dataset.ready !== undefined"
SHOWN = "return document.getElementById('count').textContent"
# Texts of a column of the table's rows that are drawn, from the top.
COLUMN = """
const heads = [...document.querySelectorAll("#heads th")].map((head) => head.textContent);
const place = heads.findIndex((head) => head.includes(arguments[0]));
const rows = [...document.querySelectorAll("#rows tr[data-place]")];
return rows.map((row) => row.cells[place].textContent);
"""
CHOOSE = """
const select = document.getElementById(arguments[0]);
select.value = arguments[1];
select.dispatchEvent(new Event("change"));
return select.value;
"""
COUNT_POINTS = """
const pixels = document.getElementById("canvas").getContext("2d").getImageData(
    0, 0, arguments[0], arguments[1]).data;
let found = 0;
for (let k = 0; k < pixels.length; k += 4) {
    const most = Math.max(pixels[k], pixels[k + 1], pixels[k + 2]);
    found += pixels[k + 3] > 0 && most - Math.min(pixels[k], pixels[k + 1], pixels[k + 2]) > 60;
}
return found;
"""


@pytest.fixture(scope="module")
def _installed(tmp_path_factory: pytest.TempPathFactory) -> None:
    ensure_browser(tmp_path_factory.mktemp("log") / "apt.log")


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A batch of 1,000 cells, 20 of which are not run."""
    folder = tmp_path_factory.mktemp("batches") / "прыжки & <i>hops</i>"
    make_batch(folder, 1000, clips=40, unfinished=20)
    collect(folder)
    return folder


@pytest.fixture(scope="module")
def manifest(large: Path) -> Manifest:
    return read_manifest(large)


@pytest.fixture(scope="module")
def window(_installed: None) -> Iterator[Browser]:
    with browser() as opened:
        yield opened


@pytest.fixture
def page(window: Browser, large: Path) -> Iterator[Browser]:
    """The large batch's page, which says nothing on the console whatever is done with it."""
    yield from opened(window, large)


def opened(window: Browser, folder: Path, fragment: str = "") -> Iterator[Browser]:
    window.open(folder / "index.html", fragment)
    window.wait(READY)
    yield window
    assert window.complaints() == []


def numbers(window: Browser) -> list[int]:
    """Cells by their numbers, as the table shows them."""
    return [int(text) for text in window.run(COLUMN, "Cell")]


def in_states(folder: Path, manifest: Manifest, *states: State) -> list[int]:
    """Numbers of the cells whose results are so."""
    results = [read_result(folder, plan.cell) for plan in manifest.cells]
    return [k for k, r in enumerate(results, start=1) if r is not None and r.state in states]


def test_a_small_batch_shows_every_cell(window: Browser, tmp_path: Path) -> None:
    folder = tmp_path / "ten"
    make_batch(folder, 10, clips=10)
    collect(folder)
    for shown in opened(window, folder):
        assert numbers(shown) == list(range(1, 11))
        assert shown.run("return document.querySelector('h1').textContent") == "ten"
        clips = shown.run(COLUMN, "Clip")
        assert clips[: len(HARD_NAMES)] == list(HARD_NAMES)


def test_names_are_text_and_never_markup(page: Browser, large: Path) -> None:
    assert page.run("return document.title") == large.name
    assert page.run("return document.querySelectorAll('i, b, main script').length") == 0
    assert page.run(COLUMN, "Clip")[: len(HARD_NAMES)] == list(HARD_NAMES)


def test_only_rows_in_sight_are_in_the_document(page: Browser) -> None:
    assert len(numbers(page)) < 60
    page.run("document.getElementById('table-box').scrollTop = 1e9")
    page.wait("return document.querySelector('#rows tr[data-place=\"999\"]') !== null")
    assert numbers(page)[-1] == 1000


def test_failures_come_first_with_their_reasons(
    page: Browser, large: Path, manifest: Manifest
) -> None:
    bad = in_states(large, manifest, State.FAILED, State.NO_SOLUTION, State.WRONG_INPUT)
    heading = page.run("return document.getElementById('problems-heading').textContent")
    assert heading == f"{len(bad)} cells without a result"
    reasons = page.run("return document.getElementById('reasons').textContent")
    assert "it ends at frame 96" in reasons
    results = [read_result(large, plan.cell) for plan in manifest.cells]
    wrong = [k for k, r in enumerate(results, start=1) if r is not None and "96" in r.sentence]
    page.run(
        "[...document.querySelectorAll('#reasons li')].find((li) => li.textContent.includes("
        "'frame 96')).querySelector('button').click()"
    )
    assert numbers(page) == wrong


def test_states_are_filters_that_add_up(page: Browser, large: Path, manifest: Manifest) -> None:
    page.click("#states button[data-state='failed']")
    assert numbers(page) == in_states(large, manifest, State.FAILED)
    page.click("#states button[data-state='wrong input']")
    both = in_states(large, manifest, State.FAILED, State.WRONG_INPUT)
    assert numbers(page) == both[: len(numbers(page))]
    assert page.run(SHOWN) == f"{len(both)} of 1,000 cells"
    page.click("#clear")
    assert page.run(SHOWN) == "1,000 cells"


def test_typing_searches_in_any_letters(page: Browser, manifest: Manifest) -> None:
    page.type("#text", "ПРЫЖОК höher")
    wanted = [
        k
        for k, plan in enumerate(manifest.cells, start=1)
        if "прыжок" in plan.clip and "höher" in plan.recipe
    ]
    assert numbers(page) == wanted[: len(numbers(page))]
    assert page.run(SHOWN) == f"{len(wanted)} of 1,000 cells"


def test_clip_recipe_and_a_values_range_hold_together(page: Browser, manifest: Manifest) -> None:
    assert page.run(CHOOSE, "clip", "jump 002.bvh") == "jump 002.bvh"
    page.run(CHOOSE, "more", "value:pin.Landing.up")
    page.type("#ranges input[aria-label$='from']", "0.1")
    page.run(CHOOSE, "recipe", "further.toml")
    wanted = [
        k
        for k, plan in enumerate(manifest.cells, start=1)
        if plan.clip.endswith("/jump 002.bvh")
        and plan.recipe.endswith("further.toml")
        and float(plan.values["pin.Landing.up"]) >= 0.1
    ]
    assert wanted
    assert numbers(page) == wanted


def test_no_cell_left_is_said(page: Browser) -> None:
    page.type("#text", "nothing is called so")
    assert page.run("return document.getElementById('none').checkVisibility()")
    assert page.run(SHOWN) == "0 of 1,000 cells"


def test_a_columns_head_sorts_and_sorts_back(page: Browser) -> None:
    heads = "[...document.querySelectorAll('#heads button')]"
    head = f"{heads}.find((button) => button.textContent.includes('flight 1 (s)'))"
    for direction in (1, -1):
        page.run(f"{head}.click()")
        column = [float(text) for text in page.run(COLUMN, "flight 1 (s)") if text != "–"]
        assert column == sorted(column, reverse=direction < 0)
        assert len(column) > 10
    assert page.run(f"return {head}.parentElement.ariaSort") == "descending"


def test_keys_alone_walk_the_table_and_open_a_cell(page: Browser) -> None:
    page.run("document.getElementById('table').focus()")
    page.press("Down", "Down", "End", "Up", "Enter")
    assert page.run("return document.getElementById('cell').open")
    name = "return document.getElementById('cell-name').textContent"
    assert page.run(name).startswith("999. ")
    page.press("Right")
    assert page.run(name).startswith("1000. ")
    page.press("Escape")
    assert not page.run("return document.getElementById('cell').open")
    assert page.run("return document.activeElement.id") == "table"


def test_a_cell_shows_its_picture_figures_and_files(page: Browser) -> None:
    page.click("#states button[data-state='done']")
    page.click("#rows tr[data-place='0']")
    image = "document.querySelector('#cell-body img')"
    page.wait(f"return {image}.complete && {image}.naturalWidth === 480")
    text = page.run("return document.getElementById('cell-body').textContent")
    assert "peak force (BW)" in text
    assert "body weights" in text
    links = page.run("return [...document.querySelectorAll('#cell-body li a')].map((a) => a.href)")
    assert len(links) == 5
    assert all("/cells/" in link for link in links)
    page.press("Escape")


def test_a_film_by_blenders_encoder_plays(window: Browser, tmp_path: Path) -> None:
    cell = make_batch(tmp_path, 1, clips=1).cells[0].cell
    home = cell_folder(tmp_path, cell)
    times = np.linspace(0.0, 0.5, 61)
    com = np.stack([times, 0 * times, 1 + 0 * times], axis=1)
    turn = np.repeat(np.eye(3)[None], len(times), axis=0)
    trunk = Limb("trunk", np.full(3, 0.5), com, turn)
    draw_film(
        [SheetRow("Slid", times, (trunk,), com, np.zeros((0, 3)))], home / "film.mp4", width=96
    )
    result = read_result(tmp_path, cell)
    assert result is not None
    with_film = replace(result, files=(*result.files, "film.mp4"))
    (home / RESULT).write_text(with_film.as_json(), encoding="utf-8")
    collect(tmp_path)
    for shown in opened(window, tmp_path):
        shown.click("#rows tr[data-place='0']")
        shown.wait("const film = document.querySelector('video'); return film.currentTime > 0.1")
        seen = shown.run(
            "const film = document.querySelector('video');"
            "return [film.videoWidth, film.duration, film.error]"
        )
        assert seen == [96, pytest.approx(13 / 24, abs=0.02), None]
        shown.press("Escape")


def test_pictures_load_only_in_sight(page: Browser) -> None:
    page.click("#as-pictures")
    page.run("document.getElementById('cells').scrollIntoView()")
    shown = "[...document.querySelectorAll('#pictures-box img')]"
    page.wait(f"return {shown}.some((image) => image.complete && image.naturalWidth > 0)")
    assert page.run(f"return {shown}.length") < 150
    page.run("document.getElementById('pictures-box').focus()")
    page.press("End", "Enter")
    assert page.run("return document.getElementById('cell-name').textContent").startswith("1000. ")
    page.press("Escape")


def test_the_plot_draws_points_and_a_rectangle_keeps_them(page: Browser) -> None:
    page.run("document.getElementById('plot').scrollIntoView()")
    wide = page.run("return document.getElementById('canvas').width")
    assert page.run(COUNT_POINTS, wide, 280) > 1000
    box = page.run("return document.getElementById('canvas').getBoundingClientRect().toJSON()")
    middle = box["left"] + box["width"] / 2
    page.drag((middle, box["top"] + 15), (box["right"] - 15, box["top"] + 290))
    forward = [float(text) for text in page.run(COLUMN, "forward")]
    assert forward
    assert min(forward) >= 0.4
    assert page.run("return document.querySelectorAll('#ranges fieldset').length") == 2


def test_a_logarithmic_axis_says_what_it_leaves_out(page: Browser) -> None:
    page.run("document.getElementById('logx').click()")
    told = page.run("return document.getElementById('left-out').textContent")
    assert "not above zero" in told
    page.run("document.getElementById('logx').click()")


def test_the_plot_goes_from_point_to_point_by_keys(page: Browser) -> None:
    page.run("document.getElementById('canvas').focus()")
    page.press("Right", "Right")
    assert "pin.Landing.forward: 0\n" in page.run(
        "return document.getElementById('tip').textContent"
    )
    page.press("Enter")
    assert page.run("return document.getElementById('cell').open")
    page.press("Escape")


def test_the_address_keeps_what_was_chosen(page: Browser, large: Path) -> None:
    page.type("#text", "hop")
    page.click("#states button[data-state='done']")
    page.run(CHOOSE, "y", "figure:flight_1_s")
    page.run("document.querySelector('#heads th:nth-child(2) button').click()")
    kept, shown = page.run("return location.hash"), numbers(page)
    for again in opened(page, large, kept):
        assert numbers(again) == shown
        assert again.run("return document.getElementById('y').value") == "figure:flight_1_s"
        assert again.run("return document.getElementById('text').value") == "hop"


def test_controls_have_names_and_the_page_loads_nothing_from_elsewhere(page: Browser) -> None:
    nameless = page.run(
        "const controls = document.querySelectorAll('button, input, select, #canvas, table');"
        "return [...controls].filter((e) => e.checkVisibility() && !(e.ariaLabel"
        " || e.labels?.length || e.textContent.trim() ||"
        " e.hasAttribute('aria-labelledby'))).map((e) => e.outerHTML)"
    )
    assert nameless == []
    loaded = page.run("return performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert [name for name in loaded if not name.startswith("file:")] == []


@pytest.mark.usefixtures("_installed")
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_text_stands_out_from_its_ground(large: Path, dark: bool) -> None:
    """At least 4.5 to 1, as WCAG 2.2 asks (1.4.3), for all colours that text is given."""
    with browser(dark=dark) as window:
        for shown in opened(window, large):
            style = (
                "return getComputedStyle(document.documentElement).getPropertyValue(arguments[0])"
            )
            grounds = [
                shown.run(style, f"--{name}") for name in ("card", "paper", "hover", "active")
            ]
            inks = ("ink", "quiet", "accent", "done", "none", "input", "failed", "planned")
            for ink in inks:
                colour = shown.run(style, f"--{ink}")
                contrasts = [contrast(colour, ground) for ground in grounds[:2]]
                assert min(contrasts) >= 4.5, ink
            assert (luminance(grounds[1]) < 0.1) is dark


def luminance(colour: str) -> float:
    """Relative luminance of "#rrggbb" (WCAG 2.2)."""
    channels = (int(colour.strip()[k : k + 2], 16) / 255 for k in (1, 3, 5))
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.usefixtures("_installed")
def test_how_soon_a_page_is_there_and_filters_can_be_measured(large: Path) -> None:
    told = measure_page(large / "index.html")
    # In no order: a loaded machine may paint only after the table is there.
    assert min(told.first_paint, told.ready, told.filter) > 0.0
