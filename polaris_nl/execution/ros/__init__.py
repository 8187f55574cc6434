"""A Stretch, real or simulated, over ROS 2. The only package that imports rclpy, and only where it is needed.

What decides is pure and works without ROS: profiles, layout, perception, skills, the watchdog.
"""
