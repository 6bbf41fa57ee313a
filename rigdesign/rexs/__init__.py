"""REXS files (Reusable Engineering EXchange Standard, FVA): a neutral gear unit, and a case from one of its stages.

    read_rexs(path) -> RexsModel        reader: XML, JSON or zip, recognised by content
    import_gear_unit(model) -> GearUnitImport   gears, meshes, shafts, bearings, couplings, oil and loads in SI, with
                                        what was mapped and what was not
    chosen_stage(unit, number) -> GearStage     gear_stage: two gears with their shafts and bearings
    case_tables(imported, stage) -> tables      case_tables: keys of the case, each stated, assumed or needed
    import_case(file, out, stage) -> ImportedCase   write_case: the file, and what became of everything

Format: schema and database of REXS 1.0 to 2.0 as published by FVA GmbH (rexs.info).
"""
