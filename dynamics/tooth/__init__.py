"""Teeth in mesh: influence numbers, loaded contact, mesh law with forces, friction and sliding, root stress."""
