"""The main job: a case in, a verdict with everything behind it out."""
