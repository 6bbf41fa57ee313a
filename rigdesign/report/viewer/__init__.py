"""The turnable picture of temperature and deformation in the report: geometry, data block, script, drawing library."""
