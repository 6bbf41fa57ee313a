"""One document, one module, the edition in the name; printed symbols and the document's units."""
