"""From text to a validated Scenario: text, expand, scenario, load."""
