"""Makes the checkout importable as the package `hangtime`, whatever its folder is called.

The repository root is the extension (relative imports throughout), so it is loaded under the
package's name the way Blender loads it, without needing a parent folder of that name.
"""

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

if "hangtime" not in sys.modules:
    spec = importlib.util.spec_from_file_location(
        "hangtime", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["hangtime"] = module
    spec.loader.exec_module(module)
