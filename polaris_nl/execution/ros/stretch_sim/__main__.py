"""`python -m polaris_nl.execution.ros.stretch_sim`: the same as `polaris-nl stretch-sim`."""

from __future__ import annotations

import subprocess
import sys

if __name__ == "__main__":
    # The command line lies above this package, which therefore can't import it.
    command = [sys.executable, "-m", "polaris_nl.cli", "stretch-sim", *sys.argv[1:]]
    sys.exit(subprocess.call(command))
