/PROG  WINDING
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "meshwind";
PROG_SIZE	= 0;
FILE_NAME	= ;
VERSION		= 0;
LINE_COUNT	= 139;
MEMORY_SIZE	= 0;
PROTECT		= READ_WRITE;
TCD:  STACK_SIZE	= 0,
      TASK_PRIORITY	= 50,
      TIME_SLICE	= 0,
      BUSY_LAMP_OFF	= 0,
      ABORT_REQUEST	= 0,
      PAUSE_REQUEST	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
CONTROL_CODE	= 00000000 00000000;
/MN
   1:  !meshwind test ;
   2:  !mandrel: pipe.stl ;
   3:  !mandrel digest: sha256/128 00000 ;
   4:  !+000000000000000000000000000 ;
   5:  !machine: Robot in front of a spi ;
   6:  !+ndle ;
   7:  !job digest: sha256/128 111111111 ;
   8:  !+11111111111111111111111 ;
   9:  !fibre: 12.345 m ;
  10:  !time: 39.9 s ;
  11:  !blocks: 99 ;
  12:  !tie on at X70.000 Y0.000 Z-1.500 ;
  13:  !+ on the mandrel ;
  14:  !axes 1 to 6: A B C U V W, extern ;
  15:  !+al: X is E1 ;
  16:  !J3 is C + B ;
  17:  UFRAME_NUM=0 ;
  18:  UTOOL_NUM=1 ;
  19:  !approach: all axes move together ;
  20:  !+, ;
  21:  !bring the eye clear of the mandr ;
  22:  !+el by hand before the start ;
  23:J P[1] 10% FINE    ;
  24:  !tie the fibre on at the landing ;
  25:  !+ point, then start again ;
  26:  PAUSE ;
  27:  !course 0 ;
  28:J P[2] 3000msec CNT100    ;
  29:J P[3] 250msec CNT100    ;
  30:  !course 1 ;
  31:J P[4] 3000msec CNT100    ;
  32:  !course 2 ;
  33:J P[5] 350msec CNT100    ;
  34:J P[6] 350msec CNT100    ;
  35:J P[7] 350msec CNT100    ;
  36:J P[8] 350msec CNT100    ;
  37:J P[9] 350msec CNT100    ;
  38:J P[10] 350msec CNT100    ;
  39:J P[11] 350msec CNT100    ;
  40:J P[12] 350msec CNT100    ;
  41:  !course 3 ;
  42:J P[13] 350msec CNT100    ;
  43:J P[14] 350msec CNT100    ;
  44:J P[15] 350msec CNT100    ;
  45:J P[16] 350msec CNT100    ;
  46:J P[17] 350msec CNT100    ;
  47:J P[18] 350msec CNT100    ;
  48:J P[19] 350msec CNT100    ;
  49:J P[20] 350msec CNT100    ;
  50:  !course 4 ;
  51:J P[21] 350msec CNT100    ;
  52:J P[22] 350msec CNT100    ;
  53:J P[23] 350msec CNT100    ;
  54:J P[24] 350msec CNT100    ;
  55:J P[25] 350msec CNT100    ;
  56:J P[26] 350msec CNT100    ;
  57:J P[27] 350msec CNT100    ;
  58:J P[28] 350msec CNT100    ;
  59:  !course 5 ;
  60:J P[29] 350msec CNT100    ;
  61:J P[30] 350msec CNT100    ;
  62:J P[31] 350msec CNT100    ;
  63:J P[32] 350msec CNT100    ;
  64:J P[33] 350msec CNT100    ;
  65:J P[34] 350msec CNT100    ;
  66:J P[35] 350msec CNT100    ;
  67:J P[36] 350msec CNT100    ;
  68:  !course 6 ;
  69:J P[37] 350msec CNT100    ;
  70:J P[38] 350msec CNT100    ;
  71:J P[39] 350msec CNT100    ;
  72:J P[40] 350msec CNT100    ;
  73:J P[41] 350msec CNT100    ;
  74:J P[42] 350msec CNT100    ;
  75:J P[43] 350msec CNT100    ;
  76:J P[44] 350msec CNT100    ;
  77:  !course 7 ;
  78:J P[45] 350msec CNT100    ;
  79:J P[46] 350msec CNT100    ;
  80:J P[47] 350msec CNT100    ;
  81:J P[48] 350msec CNT100    ;
  82:J P[49] 350msec CNT100    ;
  83:J P[50] 350msec CNT100    ;
  84:J P[51] 350msec CNT100    ;
  85:J P[52] 350msec CNT100    ;
  86:  !course 8 ;
  87:J P[53] 350msec CNT100    ;
  88:J P[54] 350msec CNT100    ;
  89:J P[55] 350msec CNT100    ;
  90:J P[56] 350msec CNT100    ;
  91:J P[57] 350msec CNT100    ;
  92:J P[58] 350msec CNT100    ;
  93:J P[59] 350msec CNT100    ;
  94:J P[60] 350msec CNT100    ;
  95:  !course 9 ;
  96:J P[61] 350msec CNT100    ;
  97:J P[62] 350msec CNT100    ;
  98:J P[63] 350msec CNT100    ;
  99:J P[64] 350msec CNT100    ;
 100:J P[65] 350msec CNT100    ;
 101:J P[66] 350msec CNT100    ;
 102:J P[67] 350msec CNT100    ;
 103:J P[68] 350msec CNT100    ;
 104:  !course 10 ;
 105:J P[69] 350msec CNT100    ;
 106:J P[70] 350msec CNT100    ;
 107:J P[71] 350msec CNT100    ;
 108:J P[72] 350msec CNT100    ;
 109:J P[73] 350msec CNT100    ;
 110:J P[74] 350msec CNT100    ;
 111:J P[75] 350msec CNT100    ;
 112:J P[76] 350msec CNT100    ;
 113:  !course 11 ;
 114:J P[77] 350msec CNT100    ;
 115:J P[78] 350msec CNT100    ;
 116:J P[79] 350msec CNT100    ;
 117:J P[80] 350msec CNT100    ;
 118:J P[81] 350msec CNT100    ;
 119:J P[82] 350msec CNT100    ;
 120:J P[83] 350msec CNT100    ;
 121:J P[84] 350msec CNT100    ;
 122:  !course 12 ;
 123:J P[85] 350msec CNT100    ;
 124:J P[86] 350msec CNT100    ;
 125:J P[87] 350msec CNT100    ;
 126:J P[88] 350msec CNT100    ;
 127:J P[89] 350msec CNT100    ;
 128:J P[90] 350msec CNT100    ;
 129:J P[91] 350msec CNT100    ;
 130:J P[92] 350msec CNT100    ;
 131:  !course 13 ;
 132:J P[93] 350msec CNT100    ;
 133:J P[94] 350msec CNT100    ;
 134:J P[95] 350msec CNT100    ;
 135:J P[96] 350msec CNT100    ;
 136:J P[97] 350msec CNT100    ;
 137:J P[98] 350msec CNT100    ;
 138:J P[99] 350msec CNT100    ;
 139:J P[100] 350msec FINE    ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=   -70.529 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,	
	J1=   159.961 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -160.529 deg
};
P[3]{
   GP1:
	UF : 0, UT : 1,	
	J1=   160.000 deg,	J2=     0.000 deg,	J3=   152.500 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -174.000 deg
};
P[4]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -264.000 deg
};
P[5]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -281.678 deg
};
P[6]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -299.355 deg
};
P[7]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -317.033 deg
};
P[8]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -334.711 deg
};
P[9]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -352.388 deg
};
P[10]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -370.066 deg
};
P[11]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -387.744 deg
};
P[12]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -405.421 deg
};
P[13]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -423.099 deg
};
P[14]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -440.777 deg
};
P[15]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -458.454 deg
};
P[16]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -476.132 deg
};
P[17]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -493.810 deg
};
P[18]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -511.487 deg
};
P[19]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -529.165 deg
};
P[20]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -546.843 deg
};
P[21]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -564.520 deg
};
P[22]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -582.198 deg
};
P[23]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -599.876 deg
};
P[24]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -617.553 deg
};
P[25]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -635.231 deg
};
P[26]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -652.909 deg
};
P[27]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -670.586 deg
};
P[28]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -688.264 deg
};
P[29]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -705.942 deg
};
P[30]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -723.619 deg
};
P[31]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -741.297 deg
};
P[32]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -758.975 deg
};
P[33]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -776.652 deg
};
P[34]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -794.330 deg
};
P[35]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -812.008 deg
};
P[36]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -829.685 deg
};
P[37]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -847.363 deg
};
P[38]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -865.041 deg
};
P[39]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -882.718 deg
};
P[40]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -900.396 deg
};
P[41]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -918.074 deg
};
P[42]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -935.751 deg
};
P[43]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -953.429 deg
};
P[44]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -971.107 deg
};
P[45]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1=  -988.784 deg
};
P[46]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1006.462 deg
};
P[47]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1024.140 deg
};
P[48]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1041.817 deg
};
P[49]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1059.495 deg
};
P[50]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1077.173 deg
};
P[51]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1094.850 deg
};
P[52]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1112.528 deg
};
P[53]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1130.206 deg
};
P[54]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1147.883 deg
};
P[55]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1165.561 deg
};
P[56]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1183.239 deg
};
P[57]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1200.916 deg
};
P[58]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1218.594 deg
};
P[59]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1236.272 deg
};
P[60]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1253.949 deg
};
P[61]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1271.627 deg
};
P[62]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1289.305 deg
};
P[63]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1306.983 deg
};
P[64]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1324.660 deg
};
P[65]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1342.338 deg
};
P[66]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1360.016 deg
};
P[67]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1377.693 deg
};
P[68]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1395.371 deg
};
P[69]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1413.049 deg
};
P[70]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1430.726 deg
};
P[71]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1448.404 deg
};
P[72]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1466.082 deg
};
P[73]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1483.759 deg
};
P[74]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1501.437 deg
};
P[75]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1519.115 deg
};
P[76]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1536.792 deg
};
P[77]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1554.470 deg
};
P[78]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1572.148 deg
};
P[79]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1589.825 deg
};
P[80]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1607.503 deg
};
P[81]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1625.181 deg
};
P[82]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1642.858 deg
};
P[83]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1660.536 deg
};
P[84]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1678.214 deg
};
P[85]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1695.891 deg
};
P[86]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1713.569 deg
};
P[87]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1731.247 deg
};
P[88]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1748.924 deg
};
P[89]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1766.602 deg
};
P[90]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1784.280 deg
};
P[91]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1801.957 deg
};
P[92]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1819.635 deg
};
P[93]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1837.313 deg
};
P[94]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1854.990 deg
};
P[95]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1872.668 deg
};
P[96]{
   GP1:
	UF : 0, UT : 1,	
	J1=   121.421 deg,	J2=     0.000 deg,	J3=   151.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1890.346 deg
};
P[97]{
   GP1:
	UF : 0, UT : 1,	
	J1=   111.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1908.023 deg
};
P[98]{
   GP1:
	UF : 0, UT : 1,	
	J1=   101.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1925.701 deg
};
P[99]{
   GP1:
	UF : 0, UT : 1,	
	J1=    91.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1943.379 deg
};
P[100]{
   GP1:
	UF : 0, UT : 1,	
	J1=    81.421 deg,	J2=     0.000 deg,	J3=   150.000 deg,
	J4=     0.000 deg,	J5=     0.000 deg,	J6=     0.000 deg,
	E1= -1961.056 deg
};
/END
