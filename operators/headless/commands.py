"""The commands `adapt`, `analyze` and `doctor`, and their options."""

import argparse
import math
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path

from ...bridge.recipe.export import ExportOptions
from ...bridge.recipe.keys import KeyOptions, require_every_frame
from ...bridge.recipe.objects import placed_objects
from ...bridge.recipe.problem import PARTS, STATURE, Recipe, parse_recipe, read_recipe_text
from ...bridge.recipe.recording import RATE
from ...bridge.recipe.result import ResultOptions
from ...solver.data.faults import BadRecipe, Fault, NoSolution, OptionNotTaken
from ...solver.data.problem import MotionProblem
from ...solver.doctor.repairs import Repairs
from ...solver.worker.pipeline import solve
from ..files.outbox import Outbox, write_new
from ..terminal.interrupts import ended_by_signals, raise_unheard
from ..terminal.outlasting import outlasting
from ..terminal.stages import WIDTH, Stages
from ..words.analysis_text import analysis_text, starter_recipe
from ..words.report_text import gravity_lines
from .clip import Clip, LoadedClip, load
from .doctor import examined, told, touched, write_recipe_of
from .doubts import doubts_about
from .earlier import clear, listed_files
from .explained import CANCELLED, FAILED, NO_SOLUTION, WRONG_INPUT, explained
from .outputs import Outputs, linked_files, require_exported, require_place
from .result_files import every_name, others, require_apart, result_lines

SCARCE = (
    "There is too little memory for this; {left}. End other programs, allow more, or take fewer "
    "frames with --first and --last."
)


@outlasting
def run(argv: Sequence[str]) -> int:
    """Parses and runs; the exit code."""
    try:
        options = parser().parse_args(argv)
    except SystemExit as end:  # argparse has said why
        return WRONG_INPUT if end.code else 0
    act: Callable[[argparse.Namespace], None] = options.act
    try:
        with ended_by_signals():
            act(options)
    except Fault as fault:
        print(explained(fault, options.recipe), file=sys.stderr)
        return NO_SOLUTION if isinstance(fault, NoSolution) else WRONG_INPUT
    except KeyboardInterrupt as end:
        print(f"\nCancelled; {_left(end)}.", file=sys.stderr)
        return CANCELLED
    except MemoryError as end:
        print(SCARCE.format(left=_left(end)), file=sys.stderr)
        return FAILED
    return 0


def _left(end: BaseException) -> str:
    """What a command that ended early has written, which an Outbox notes."""
    return "; ".join(getattr(end, "__notes__", ["nothing was written"]))


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    top = argparse.ArgumentParser(prog="hangtime", description="Adapts recorded jumps by physics.")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    adapting = commands.add_parser("adapt", help="adapt a clip as a recipe says")
    adapting.set_defaults(act=adapt)
    adapting.add_argument("--recipe", type=Path, required=True, help="TOML or JSON file")
    adapting.add_argument(
        "--out",
        type=Path,
        default=Path("out"),
        metavar="DIR",
        help="for the results (default: out)",
    )
    adapting.add_argument(
        "--no-picture", action="store_true", help="leave out sheet.png, half of the time"
    )
    analyzing = commands.add_parser("analyze", help="print a clip's phases and contacts")
    analyzing.set_defaults(act=analyze)
    analyzing.add_argument(
        "--recipe", type=Path, help="whose [file], frames, bones, repairs and objects count"
    )
    analyzing.add_argument(
        "--write-recipe", type=Path, metavar="FILE", help="leave a recipe to start from"
    )
    doctoring = commands.add_parser("doctor", help="tell what is wrong with a clip, and remedies")
    doctoring.set_defaults(act=doctor)
    doctoring.add_argument("--recipe", type=Path, help="whose [file] and bones count")
    doctoring.add_argument("--json", action="store_true", help="print it for a program")
    doctoring.add_argument(
        "--write-recipe", type=Path, metavar="FILE", help="leave a recipe that repairs the clip"
    )
    for each in (adapting, analyzing, doctoring):
        _add_clip_options(each, optional=each is adapting)
    return top


def _add_clip_options(each: argparse.ArgumentParser, *, optional: bool) -> None:
    count = "?" if optional else None
    words = "BVH, FBX or AMC file, or .blend"
    each.add_argument("clip", type=Path, nargs=count, metavar="CLIP", help=words)
    each.add_argument("--first", type=_number, metavar="FRAME", help="first frame")
    each.add_argument("--last", type=_number, metavar="FRAME", help="last frame")
    each.add_argument("--mass", type=_positive, metavar="KG", help="mass (default: 70)")
    each.add_argument("--height", type=_stature, metavar="M", help="the performer's true height")
    each.add_argument("--unit", type=_positive, metavar="M", help="metres per unit of the file")
    each.add_argument("--up", choices=("Y", "Z"), type=str.upper, help="axis that points up")
    each.add_argument(
        "--rate",
        type=_rate,
        metavar="HZ",
        help="frames a second of an AMC file, or instead of what a BVH file tells",
    )
    each.add_argument("--asf", type=Path, metavar="FILE", help="an AMC file's skeleton")
    each.add_argument("--take", metavar="NAME", help="which, of an FBX file that holds several")
    each.add_argument("--armature", metavar="NAME", help="whose motion, of such a file or a .blend")
    each.add_argument(
        *("--bone", "--bones"),
        type=_bone,
        action="extend",
        nargs="+",
        default=[],
        metavar="PART=BONE",
        help='such as "left foot=Fuss.L"',
    )


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{text!r} is not a finite number")
    return number


def _positive(text: str) -> float:
    number = _number(text)
    if number <= 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return number


def _rate(text: str) -> float:
    rate = _number(text)
    if not RATE.holds(rate):
        raise argparse.ArgumentTypeError(f"{text} is not {RATE.words}")
    return rate


def _stature(text: str) -> float:
    height = _number(text)
    if not STATURE.holds(height):
        raise argparse.ArgumentTypeError(f"{text} is not {STATURE.words}")
    return height


def _bone(text: str) -> tuple[str, str]:
    part, equals, bone = text.partition("=")
    if not (equals and part.strip() and bone.strip()):
        raise argparse.ArgumentTypeError(f'{text!r} is not of the form "left foot=Fuss.L"')
    part = part.strip().lower()
    if part not in PARTS:
        raise argparse.ArgumentTypeError(
            f"unknown part of the body {part!r}; known: {', '.join(PARTS)}"
        )
    return part, bone.strip()


# ---------------------------------------------------------------- the commands


def adapt(options: argparse.Namespace) -> None:
    """The main job: a recorded clip in, an adapted one out, with its report.

    Raises NoSolution, having written the report, and any other Fault having written nothing.
    """
    recipe = _recipe(options)
    clip, problem = _clip(options, recipe), overridden(recipe.problem, options)
    wanted, keys = recipe.result or ResultOptions(), recipe.keys or KeyOptions()
    export = recipe.export or ExportOptions()
    if recipe.loop is not None:
        require_every_frame(keys)
    stages = Stages(sys.stdout)
    inputs = (*clip.files, options.recipe, *recipe.meshes)
    require_apart(inputs, options.out, export)
    with Outbox(options.out) as outbox:
        outbox.claim(every_name())
        loaded = load(clip, problem, stages, recipe.repairs)
        linked = linked_files()
        require_apart(linked, options.out, export)
        require_place(loaded, wanted, recipe.loop)
        require_exported(loaded, options.out, export)
        _ask_about(problem, loaded, recipe.repairs)
        placed = placed_objects(recipe.under, loaded.subject.problem, loaded.subject.analysis)
        result = solve(loaded.subject.with_objects(placed), stages)
        outputs = Outputs(loaded, wanted, keys, result, outbox, stages, recipe.loop, export)
        if result.fault is not None:
            outputs.write_failure()
            print(*_delivered(outbox, (*inputs, *linked)), sep="\n")
            raise result.fault
        report = outputs.write(picture=not options.no_picture)
        told = result_lines(result, report, loaded.subject.analysis.unseen)
        total = f"{'Total':<{WIDTH}}{stages.total:6.1f} s"
        print(total, *told, *_delivered(outbox, (*inputs, *linked)), sep="\n")


def _delivered(outbox: Outbox, inputs: Iterable[Path]) -> list[str]:
    """The files are in their places, and none that an earlier run wrote is beside them, but for
    what was made from it and for the inputs; lines that tell of it. Raises OutputNotWritable."""
    raise_unheard()
    listed = listed_files(outbox.folder)
    written = outbox.deliver()
    lines = ["Written:", *(f"  {path}" for path in written)]
    return lines + clear(others(outbox.folder, (*written, *inputs)), listed)


def analyze(options: argparse.Namespace) -> None:
    """Prints what a clip holds; leaves a recipe where asked. Raises Fault."""
    asked = _recipe(options)
    clip, problem = _clip(options, asked), overridden(asked.problem, options)
    loaded = load(clip, problem, Stages(sys.stdout), asked.repairs)
    _ask_about(problem, loaded, asked.repairs)
    print()
    print(analysis_text(loaded.subject.analysis, loaded.origin), end="")
    target: Path | None = options.write_recipe
    if target is not None:
        stated = clip.stated(target), asked.repairs
        text = starter_recipe(loaded.subject.analysis, loaded.problem, clip.path, target, *stated)
        write_new(target, text)
        print(f"\nWritten:\n  {target}")


def _ask_about(problem: MotionProblem, loaded: LoadedClip, repairs: Repairs | None) -> None:
    """Prints what is hardly meant, and whose shapes are a mesh's, before anything takes its time.

    problem: as it was asked for.
    """
    from ..words.shape_text import shapes_told  # bpy's, which is loaded by now

    subject = loaded.subject
    bodies = [body.name for body in subject.analysis.performance.character.bodies]
    for line in shapes_told(loaded.skin, bodies, subject.fleshed).splitlines():
        print(line)
    for line in gravity_lines(problem.requests.body.gravity):
        print(f"Gravity: {line}")
    for doubt in doubts_about(problem, repairs, subject, loaded.origin):
        print(f"Warning: {doubt}", file=sys.stderr)


def doctor(options: argparse.Namespace) -> None:
    """Prints what is wrong with a clip as it was recorded; leaves a recipe where asked.

    A recipe tells how the clip is read, which bone is which, and which contacts carry the body; the
    frames that it chooses are counted in what its own repairs leave, so neither counts. Raises
    Fault.
    """
    asked = _recipe(options)
    as_recorded = MotionProblem(bones=asked.problem.bones)
    clip, problem = _clip(options, asked), overridden(as_recorded, options)
    examination = examined(clip, problem, options.mass, touched(asked))
    print(told(examination, as_json=options.json), end="")
    target: Path | None = options.write_recipe
    if target is not None:
        write_recipe_of(examination, target)
        print(f"\nWritten:\n  {target}", file=sys.stderr if options.json else sys.stdout)


def _recipe(options: argparse.Namespace) -> Recipe:
    """The recipe given, else one that says nothing. Raises BadRecipe."""
    path: Path | None = options.recipe
    if path is None:
        return Recipe(MotionProblem())
    return parse_recipe(read_recipe_text(path), str(path))


def _clip(options: argparse.Namespace, recipe: Recipe) -> Clip:
    """The clip given, else the recipe's, to be read as the options say, else as the recipe does.

    Raises BadRecipe where there is neither, OptionNotTaken.
    """
    path: Path | None = options.clip
    if path is None:
        if recipe.clip is None:
            problem = 'no recording; name one on the command line, or here as clip = "..."'
            raise BadRecipe(str(options.recipe), None, problem)
        path = options.recipe.parent / recipe.clip
    given = {name: getattr(options, name) for name in _ALL}
    stated = asdict(recipe.file)
    _require_taken(path, {f"--{name}": value for name, value in given.items()})
    _require_taken(path, stated)
    if recipe.file.asf is not None:
        stated["asf"] = options.recipe.parent / recipe.file.asf
    return Clip(path, **{n: stated[n] if given[n] is None else given[n] for n in _ALL})


# By suffix: the options, and keys of a recipe, about how such a file is read.
_ALL = ("unit", "up", "rate", "asf", "armature", "take")
_TAKEN = {
    ".bvh": ("unit", "up", "rate"),
    ".amc": ("unit", "up", "rate", "asf"),
    ".fbx": ("unit", "armature", "take"),
    ".blend": ("armature",),
}


def _require_taken(path: Path, stated: Mapping[str, object]) -> None:
    """Raises OptionNotTaken for an option, or a recipe's key, that would go unheard."""
    taken = _TAKEN.get(path.suffix.lower(), _ALL)
    for name, value in stated.items():
        if value is not None and name.removeprefix("--") not in taken:
            raise OptionNotTaken(name, path.name)


def overridden(problem: MotionProblem, options: argparse.Namespace) -> MotionProblem:
    """The problem with what the command line says in place of what the recipe says."""
    first, last = problem.frames or (-math.inf, math.inf)
    frames = (
        first if options.first is None else options.first,
        last if options.last is None else options.last,
    )
    return replace(
        problem,
        frames=None if frames == (-math.inf, math.inf) else frames,
        mass=problem.mass if options.mass is None else options.mass,
        height=problem.height if options.height is None else options.height,
        bones=problem.bones | dict(options.bone),
    )
