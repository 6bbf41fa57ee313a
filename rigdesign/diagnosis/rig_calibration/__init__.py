"""A rig calibrated by its own healthy sets: drift, channels and model error as a file that a diagnosis uses.

estimate.py       shipped values updated by two to four sets; channels.py: channels that shift from set to set
leave_one_out.py  every set diagnosed with the others
healthy_sets.py   from files to the calibration; document.py, reading.py: to the file and back
"""
