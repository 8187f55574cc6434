"""The executor: a pure core that turns a branching plan into goals for a robot, and robot back ends."""
