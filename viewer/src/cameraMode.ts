/** Whose frame the camera keeps: the machine's, or that of the mandrel as it turns. */
export type CameraMode = 'machine' | 'mandrel';
