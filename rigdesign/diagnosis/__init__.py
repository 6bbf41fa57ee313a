"""Where measured data and the model part: which effect the model lacks, how sure that is, and what it leaves."""
