"""A case file from the gear unit of a REXS file: one stage becomes the gearbox of the specimens.

chosen_stage(unit, number) -> GearStage         stage: two gears with their shafts and bearings
case_tables(imported, stage) -> tables      case_tables: keys of the case, each stated, assumed or needed
import_case(file, out, stage) -> ImportedCase    write: the file, and what became of everything
"""
