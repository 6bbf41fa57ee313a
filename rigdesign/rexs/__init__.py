"""REXS files (Reusable Engineering EXchange Standard, FVA), read and turned into a neutral gear unit.

    read_rexs(path) -> RexsModel        reader: XML, JSON or zip, recognised by content
    import_gear_unit(model) -> GearUnitImport   gears, meshes, shafts, bearings, couplings, oil and loads in SI, with
                                        what was mapped and what was not

Format: schema and database of REXS 1.0 to 2.0 as published by FVA GmbH (rexs.info). The package knows nothing of a
case.
"""
