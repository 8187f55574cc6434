"""`stretch-sim`: a Stretch that is simulated in a process of its own, behind its driver's ROS 2 interface.

What decides is pure and takes the time from outside; only `node.py` imports rclpy, `mujoco_body.py` and what
it uses import MuJoCo, `picture.py` what draws.
"""
