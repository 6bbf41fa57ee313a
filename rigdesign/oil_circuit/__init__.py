"""Oil circuits that feed the consumers of a rig, steady and over time: tank, pump, heater, coolers, valves, pipes."""
