"""`stretch-sim`: a Stretch that is simulated in a process of its own, behind its driver's ROS 2 interface.

What decides is pure and takes the time from outside; only `node.py` imports rclpy, `mujoco_body.py` and what
it uses import MuJoCo, `picture.py` what draws.
"""

import os

# Pictures are drawn without a screen. MuJoCo reads this when it is imported, which is later.
os.environ.setdefault("MUJOCO_GL", "egl")
