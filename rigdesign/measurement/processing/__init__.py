"""From readings to the numbers that a prediction is held against."""
