"""One job = options dataclass + read + compute + name products + write; no click."""
