"""Thermal history: what heats the housings over the schedule, their temperatures, their clearances."""
