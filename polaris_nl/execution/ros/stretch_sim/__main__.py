"""`python -m polaris_nl.execution.ros.stretch_sim`: the same as `polaris-nl stretch-sim`."""

from __future__ import annotations

import os
import sys

if __name__ == "__main__":
    # The command line lies above this package, which therefore can't import it. This process becomes that
    # one, so that signals reach it.
    os.execv(sys.executable, [sys.executable, "-m", "polaris_nl.cli", "stretch-sim", *sys.argv[1:]])
