"""Speech: audio to utterances. Vosk and the sound libraries are imported only here, and only when needed."""
